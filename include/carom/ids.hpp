#pragma once

#include <cstdint>

namespace carom {

/// A handle to something that lives in a `World<D>`. It stays valid until that thing is removed; after
/// that it is refused, even when its place has been taken by another (the generation tells). A handle of
/// one dimension does not convert to one of the other. The default handle names nothing.
template <int D, class Kind>
struct Id {
    std::uint32_t index = 0xffffffffu;
    std::uint32_t generation = 0;

    /// True when the handle names something (which may have been removed since).
    constexpr explicit operator bool() const { return index != 0xffffffffu; }
    friend constexpr bool operator==(const Id&, const Id&) = default;
};

/// Tags that keep the handles apart.
struct BodyTag;
struct ShapeTag;
struct ForceTag;

/// Handle of a body.
template <int D>
using BodyId = Id<D, BodyTag>;
/// Handle of a shape on a body.
template <int D>
using ShapeId = Id<D, ShapeTag>;
/// Handle of a force generator.
template <int D>
using ForceId = Id<D, ForceTag>;

}  // namespace carom
