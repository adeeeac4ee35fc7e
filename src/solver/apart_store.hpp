#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/crew.hpp"
#include "dynamics/contact_cache.hpp"
#include "solver/lane_shapes.hpp"
#include "solver/lane_store.hpp"
#include "solver/passes.hpp"

namespace carom::detail {

/// The pairs that do not touch, from step to step. Most of the pairs whose boxes overlap do not, for many
/// steps, and a body in a crowd has several; here one costs little more than to read where its bodies are.
template <int D>
class ApartStore {
  public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    ApartStore();

    std::size_t size() const { return contact_.size(); }
    /// Takes up a contact whose cache tells of a gap, or whose shapes are for lanes, and returns its index.
    std::uint32_t add(std::uint32_t contact, std::uint32_t body_a, std::uint32_t body_b,
                      const ContactCache<D>& cache, double radius_a, double radius_b,
                      const LanePair<D>& shapes);
    /// The last one takes the index of the removed one; its number is returned, or `none` if it was the last.
    std::uint32_t remove(std::uint32_t index);
    /// The contact has another number now.
    void rename(std::uint32_t index, std::uint32_t contact) { contact_[index] = contact; }

    std::uint32_t contact(std::uint32_t index) const { return contact_[index]; }
    std::uint32_t body_a(std::uint32_t index) const { return body_a_[index]; }
    std::uint32_t body_b(std::uint32_t index) const { return body_b_[index]; }

    /// The contacts that may touch now or within the step, in the order of their indices.
    std::span<const std::uint32_t> find_near(std::span<const BodyState<D>> states,
                                             const LaneShapes<D>& shapes, const ApartLimits<float>& limits,
                                             Scheduler* scheduler);

  private:
    const Passes<D>* passes_;
    LaneStore<ApartMarks<D, float>> marks_;
    std::vector<std::uint32_t> body_a_, body_b_, shape_a_,
        shape_b_;  ///< by lane, to the end of the last block
    std::vector<std::uint32_t> contact_;
    std::vector<std::uint32_t> found_;  ///< by block, a bit a lane
    std::vector<std::uint32_t> near_;
};

}  // namespace carom::detail
