#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "carom/world.hpp"
#include "dynamics/body.hpp"
#include "dynamics/solids.hpp"

/// What a world keeps of its bodies, shapes and events, beside what the layers below know of them.
namespace carom::detail {

/// The trees of shapes: what rests is kept apart, as nothing about it changes, and what moves is often
/// looked at as a whole.
enum TreeKind : std::uint8_t { of_fixed, of_resting, of_moving };

/// Whom a shape meets: what is asked of it for every neighbour.
struct Company {
    std::uint64_t category = 0, mask = 0;
    std::uint32_t body = 0;
    std::int32_t group = 0;
    bool senses = false;     ///< it is a sensor
    bool is_ground = false;  ///< it is a terrain
};

/// What is new about the fat box of a shape.
enum BoxNews : std::uint8_t {
    is_new = 1,       ///< it changed
    renewed_now = 2,  ///< it changes while new boxes are looked for
    meets_anew = 4,   ///< some of its pairs may be gone, or may be from now on, whose boxes overlap as before
};

/// How a body moves in a step.
enum : std::uint8_t {
    stands_still,   ///< fixed, at rest or asleep
    moved_by_user,  ///< kinematic, with a velocity
    moves_freely,   ///< dynamic and awake
};

/// Where a shape may be on its body, as is asked for each that moves: in a box in the axes of the body, grown
/// by a radius.
template <int D>
struct Extent {
    Vec<D> middle{}, half{};  ///< the box; its middle from the centre of mass
    double radius = 0;
    double arm = 0;        ///< a point of it comes no further than this by a turn of one radian
    double to_strike = 0;  ///< margin that it needs because it may bounce
};

/// What a step made of a body.
enum Outcome : std::uint8_t {
    went_far = 1,     ///< it may have passed through something
    went_wrong = 2,   ///< its state is not finite
    went_astray = 4,  ///< it is not where its velocity at the start of the step would have brought it
    was_stopped = 8,  ///< it was put back since that was asked
};

/// What is known of a body while islands at rest are looked for.
enum class Rest : std::uint8_t {
    none,      ///< it stays awake
    possible,  ///< it rests itself
    seen,      ///< it belongs to the island that is being gathered, or to one that fell asleep
};

/// A contact of an awake dynamic body with a fixed shape.
struct FixedContact {
    std::uint32_t body = 0, shape = 0;   ///< what moves
    std::uint32_t other = 0, facet = 0;  ///< the fixed shape
    std::uint32_t contact = 0;
};

/// A sensor and a shape whose bounds overlap.
struct SensorPair {
    std::uint32_t sensor = 0, visitor = 0;  ///< shapes
    bool inside = false;
    bool placed_anew = true;  ///< one of the two was moved by the user, or the pair is new
};

/// The body that was added last, checked and worked out. Who adds many that are alike, but for place, motion
/// and name, pays for one.
template <int D>
struct Blueprint {
    BodyDefinition<D> definition;  ///< without its shapes
    std::vector<std::shared_ptr<const ShapeModel<D>>> shapes;
    BodyMass<D> mass;
    bool made = false;

    bool serves(const BodyDefinition<D>& wanted) const;
};

/// What happened: filled by a step and by what is removed before it.
template <int D>
struct EventBuffers {
    std::vector<ContactBegin<D>> contact_begins;
    std::vector<ContactEnd<D>> contact_ends;
    std::vector<ContactHit<D>> contact_hits;
    std::vector<SensorBegin<D>> sensor_begins;
    std::vector<SensorEnd<D>> sensor_ends;
    std::vector<JointBreak<D>> joint_breaks;

    void clear() {
        contact_begins.clear();
        contact_ends.clear();
        contact_hits.clear();
        sensor_begins.clear();
        sensor_ends.clear();
        joint_breaks.clear();
    }
};

}  // namespace carom::detail
