#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/body.hpp"
#include "geometry/shape.hpp"
#include "simd/scalar.hpp"

namespace carom::detail {

/// Shapes that can be collided in lanes, as the passes read them: groups of four floats, the corners seen
/// from the centre of mass of their body.
template <int D>
class LaneShapes;

/// The corners of what has no more than eight: balls, capsules, boxes and most hulls. All groups are there:
/// after the last corner they repeat it.
template <>
class LaneShapes<2> {
  public:
    static constexpr int most_corners = 8;
    static constexpr std::size_t stride = 4 * (1 + most_corners);  ///< floats a shape
    static constexpr std::uint32_t none = 0;                       ///< stands for shapes that are not here

    /// Where the shape, by its index in the world, is; `none` when it is not of a kind for lanes.
    std::uint32_t find(std::uint32_t shape, const Shape<2>& its, const BodyMass<2>& mass);
    /// The shape was removed, or is different from now on.
    void forget(std::uint32_t shape);

    const float* data() const { return floats_.data(); }

  private:
    static constexpr std::uint32_t unknown = ~std::uint32_t{0};

    std::vector<float> floats_ = std::vector<float>(stride, 0.0f);
    std::vector<std::uint32_t> places_;  ///< by shape
    std::vector<std::uint32_t> free_;
};

/// Nothing in space is collided in lanes so far.
template <>
class LaneShapes<3> {
  public:
    static constexpr std::uint32_t none = 0;
    std::uint32_t find(std::uint32_t, const Shape<3>&, const BodyMass<3>&) { return none; }
    void forget(std::uint32_t) {}
    const float* data() const { return nullptr; }
};

/// The two shapes of a contact in `LaneShapes`.
template <int D>
struct LanePair {
    std::uint32_t a = LaneShapes<D>::none, b = LaneShapes<D>::none;

    /// Can they be collided in lanes?
    explicit operator bool() const { return a != LaneShapes<D>::none && b != LaneShapes<D>::none; }
};

}  // namespace carom::detail
