#include "carom/parts/character.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

template <int D>
Capsule<D> capsule_of(const CharacterDefinition<D>& c) {
    require_finite(c.position, "position");
    require_finite(c.up, "up");
    if (!(length(normalized(c.up)) > 0.5)) throw Error("up: a direction has a length");
    require_positive(c.radius, "radius");
    require_finite(c.height, "height");
    if (!(c.height > 2 * c.radius))
        refuse("height", c.height, "is not more than twice the radius, " + to_text(c.radius));
    require_in(c.max_slope, 0, 0.5 * pi, "max_slope");
    require_not_negative(c.step_height, "step_height");
    require_positive(c.mass, "mass");
    require_not_negative(c.push_force, "push_force");
    require_not_negative(c.gravity, "gravity");
    require_positive(c.margin, "margin");
    if (c.margin >= c.radius) refuse("margin", c.margin, "is not less than the radius, " + to_text(c.radius));
    const Vec<D> half = (0.5 * c.height - c.radius) * normalized(c.up);
    return {-half, half, c.radius};
}

/// What is left of v without its part along the unit vector n.
template <int D>
Vec<D> across(const Vec<D>& v, const Vec<D>& n) {
    return v - dot(v, n) * n;
}

constexpr double nothing = 1e-9;  // m

}  // namespace

template <int D>
Character<D>::Character(World<D>& world, const CharacterDefinition<D>& definition)
    : definition_(definition), solid_(capsule_of(definition)) {
    definition_.up = normalized(definition_.up);
    BodyDefinition<D> body;
    body.type = BodyType::kinematic;
    body.position = definition_.position + 0.5 * definition_.height * definition_.up;
    body.shapes.push_back({capsule_of(definition)});
    body.shapes.back().filter = definition_.shape_filter;
    body_ = world.add_body(body);
    definition_.filter.ignored = body_;
    least_rise_ = cos(definition_.max_slope);
    ground_normal_ = definition_.up;
}

template <int D>
Vec<D> Character<D>::position(const World<D>& world) const {
    return world.position(body_) - 0.5 * definition_.height * definition_.up;
}

template <int D>
void Character<D>::jump(double speed) {
    require_not_negative(speed, "speed");
    jump_speed_ = speed;
}

template <int D>
void Character<D>::place(World<D>& world, const Vec<D>& position) {
    require_finite(position, "position");
    world.set_transform(body_, {position + 0.5 * definition_.height * definition_.up, {}});
    world.set_velocity(body_, {});
    ground_.reset();
    slope_.reset();
    vertical_speed_ = jump_speed_ = 0;
}

template <int D>
void Character<D>::move(World<D>& world, const Vec<D>& velocity, double dt) {
    require_finite(velocity, "velocity");
    require_positive(dt, "dt");
    const Vec<D>& up = definition_.up;
    const Vec<D> start = world.position(body_);
    if (ground_ && !world.contains(*ground_)) ground_.reset();

    Vec<D> at = pushed_out(world, start);
    if (ground_ && jump_speed_ > 0) {
        vertical_speed_ = jump_speed_ + dot(up, world.velocity_at(*ground_, ground_point_));
        ground_.reset();
    }
    jump_speed_ = 0;
    at = walk(world, at, across(velocity, up) * dt, dt);
    at = ground_ ? settle(world, at) : fall(world, at, dt);
    if (ground_) {
        // What it stands on has still to move in this step, and takes it along.
        at += advance(world, at, world.velocity_at(*ground_, ground_point_) * dt, *ground_).done;
        if (world.type(*ground_) == BodyType::dynamic)
            world.apply_impulse(*ground_, (-definition_.mass * definition_.gravity * dt) * up, ground_point_);
    }
    world.set_velocity(body_, (at - start) / dt);
}

/// The way up to where the capsule would come nearer to something than the margin.
template <int D>
typename Character<D>::Way Character<D>::advance(const World<D>& world, const Vec<D>& from, const Vec<D>& way,
                                                 std::optional<BodyId<D>> passes) const {
    const double length = carom::length(way);
    if (length < nothing) return {};
    QueryFilter<D> filter = definition_.filter;
    if (passes) {
        filter.accepts = [&world, &given = definition_.filter.accepts, passes](ShapeId<D> shape) {
            return world.body_of(shape) != *passes && (!given || given(shape));
        };
    }
    // The margin along the normal is longer along a way that grazes; what it only grazes is looked for as
    // far.
    const double margin = definition_.margin, longest = 10 * margin;
    const Vec<D> direction = way / length;
    const auto hit = world.cast_shape(solid_, {from, {}}, (length + longest) * direction, filter);
    if (!hit) return {way, {}};
    const double approach = std::max(-dot(hit->normal, direction), 0.1);
    const double reached = hit->fraction * (length + longest) - margin / approach;
    if (reached >= length) return {way, {}};
    return {std::max(reached, 0.0) * direction, hit};
}

template <int D>
bool Character<D>::is_walkable(const Vec<D>& normal) const {
    return dot(normal, definition_.up) >= least_rise_;
}

/// Does what was hit from above carry it? A steep normal may be that of an edge, as of a step: then what
/// counts is the face behind the edge.
template <int D>
bool Character<D>::carries(const World<D>& world, const WorldHit<D>& hit, const Vec<D>& at) const {
    const Vec<D>& up = definition_.up;
    if (is_walkable(hit.normal)) return true;
    const double height = dot(hit.point - at, up) + 0.5 * definition_.height;
    if (dot(hit.normal, up) <= 0 || height > definition_.step_height + definition_.margin) return false;
    const double probe = definition_.margin;
    const Vec<D> behind = hit.point - probe * normalized(across(hit.normal, up));
    const auto face = world.cast_ray({behind + probe * up, (-2 * probe) * up}, definition_.filter);
    return face && face->fraction > 0 && is_walkable(face->normal);
}

template <int D>
void Character<D>::stand_on(const WorldHit<D>& hit) {
    ground_ = hit.body;
    ground_point_ = hit.point;
    ground_normal_ = hit.normal;
    slope_.reset();
    vertical_speed_ = 0;
}

/// Out of what it overlaps, if something was put or moved there; bodies that can be pushed give way
/// themselves.
template <int D>
Vec<D> Character<D>::pushed_out(const World<D>& world, Vec<D> at) const {
    for (int round = 0; round < 4; ++round) {
        bool moved = false;
        for (const ShapeId<D> shape : world.overlapping(solid_, {at, {}}, definition_.filter)) {
            const BodyId<D> other = world.body_of(shape);
            if (world.type(other) == BodyType::dynamic) continue;
            const auto apart =
                separation(solid_, {at, {}}, Solid<D>(world.shape(shape)), world.transform(other));
            if (!apart || apart->distance >= 0) continue;
            at += (apart->distance - 0.5 * definition_.margin) * apart->axis;
            moved = true;
        }
        if (!moved) break;
    }
    return at;
}

/// Across `up`, along what stands in the way, over steps and up slopes.
template <int D>
Vec<D> Character<D>::walk(World<D>& world, Vec<D> at, Vec<D> way, double dt) const {
    const Vec<D>& up = definition_.up;
    const Vec<D> wish = way;
    std::optional<Vec<D>> before;  // the wall that it slides along
    for (int round = 0; round < 5 && length(way) > nothing; ++round) {
        const Way step = advance(world, at, way);
        at += step.done;
        if (!step.hit) break;
        push(world, *step.hit, way, dt);
        const Vec<D> rest = way - step.done;
        Vec<D> normal = step.hit->normal;
        if (!is_walkable(normal)) {
            if (ground_) {
                if (const auto higher = climb(world, at, rest)) return *higher;
            }
            // Steep slopes and ceilings are walls: it neither walks up nor is pressed down.
            const Vec<D> level = normalized(across(normal, up));
            if (level != Vec<D>{}) normal = level;
        }
        way = across(rest, normal);
        if (before && dot(way, *before) < 0) {
            // Between two walls the crease is left; in the plane nothing.
            if constexpr (D == 2) {
                break;
            } else {
                const Vec3 crease = normalized(cross(normal, *before));
                way = dot(rest, crease) * crease;
            }
        }
        if (dot(way, wish) <= 0) break;
        before = normal;
    }
    return at;
}

/// Up, on and down again, if that leads to ground.
template <int D>
std::optional<Vec<D>> Character<D>::climb(const World<D>& world, const Vec<D>& at, const Vec<D>& way) const {
    const Vec<D>& up = definition_.up;
    if (definition_.step_height == 0) return {};
    const Vec<D> level = across(way, up);
    if (length(level) < nothing) return {};
    const Vec<D> raised = at + advance(world, at, definition_.step_height * up).done;
    const Way ahead = advance(world, raised, level);
    if (dot(ahead.done, level) < 0.01 * dot(level, level)) return {};
    const Vec<D> over = raised + ahead.done;
    const double height = dot(raised - at, up);
    const Way down = advance(world, over, -(height + definition_.margin) * up);
    if (!down.hit || !carries(world, *down.hit, over + down.done)) return {};
    const double step = dot(down.hit->point - at, up) + 0.5 * definition_.height;
    if (step > definition_.step_height + definition_.margin) return {};
    return over + down.done;
}

/// Keeps its feet on the ground as that goes down, or finds that there is none any more.
template <int D>
Vec<D> Character<D>::settle(World<D>& world, const Vec<D>& at) {
    const Way down = advance(world, at, -(definition_.step_height + 2 * definition_.margin) * definition_.up);
    ground_.reset();
    if (!down.hit || !carries(world, *down.hit, at + down.done)) return at;
    stand_on(*down.hit);
    return at + down.done;
}

template <int D>
Vec<D> Character<D>::fall(World<D>& world, Vec<D> at, double dt) {
    const Vec<D>& up = definition_.up;
    const double before = vertical_speed_;
    const double steepness = slope_ ? 1 - dot(*slope_, up) * dot(*slope_, up) : 1;  // sin² of the slope
    vertical_speed_ -= steepness * definition_.gravity * dt;
    Vec<D> way = (0.5 * (before + vertical_speed_) * dt) * up;
    if (slope_) way = across(way, *slope_) / steepness;
    slope_.reset();
    for (int round = 0; round < 4 && length(way) > nothing; ++round) {
        const Way step = advance(world, at, way);
        at += step.done;
        if (!step.hit) break;
        const Vec<D>& normal = step.hit->normal;
        if (dot(way, up) < 0 && carries(world, *step.hit, at)) {
            stand_on(*step.hit);
            break;
        }
        push(world, *step.hit, way, dt);
        const double rise = dot(normal, up);
        if (vertical_speed_ > 0 && rise < 0) vertical_speed_ = 0;
        if (vertical_speed_ < 0 && rise > 0) {
            if (!slope_) vertical_speed_ *= 1 - rise * rise;
            slope_ = normal;
        }
        way = across(way - step.done, normal);
    }
    return at;
}

/// Brings what it runs into up to its own speed, by the force that it has.
template <int D>
void Character<D>::push(World<D>& world, const WorldHit<D>& hit, const Vec<D>& way, double dt) const {
    if (world.type(hit.body) != BodyType::dynamic) return;
    const Vec<D> inwards = -hit.normal;
    const double missing = dot(way / dt - world.velocity_at(hit.body, hit.point), inwards);
    if (!(missing > 0)) return;
    const double impulse =
        std::min(definition_.push_force * dt, missing * world.mass_properties(hit.body).mass);
    world.apply_impulse(hit.body, impulse * inwards, hit.point);
}

template class Character<2>;
template class Character<3>;

}  // namespace carom
