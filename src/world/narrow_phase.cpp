#include <algorithm>
#include <cmath>

#include "world/meeting.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

/// The radius of the smaller body, of those that have one.
template <int D>
double smaller_radius(const BodyMass<D>& a, const BodyMass<D>& b) {
    if (a.radius == 0 || b.radius == 0) return std::max(a.radius, b.radius);
    return std::min(a.radius, b.radius);
}

/// Radius of the shape's curvature where it touches along `normal` (in its body's frame): a cylinder or cone
/// is round on its side and flat on its base.
template <int D>
double roundness(const Shape<D>& shape, const Vec<D>& normal) {
    if (shape.kind == ShapeKind::plane) return 0;
    if (shape.kind != ShapeKind::cylinder && shape.kind != ShapeKind::cone) return shape.radius;
    return std::fabs(dot(normal, shape.b)) < 0.5 ? shape.radius : 0;
}

}  // namespace

namespace {

/// Has the shape nothing but flat faces, so that what touches stays where it is on them?
template <int D>
bool is_flat(const Shape<D>& shape) {
    return (shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull) && shape.radius == 0;
}

}  // namespace

/// The manifold of two bodies that are placed so, marked on both.
template <int D>
void WorldState<D>::touch(const ContactRecord<D>& c, const BodyState<D>& a, const BodyState<D>& b,
                          double reach, ContactCache<D>& cache) const {
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const Shape<D>&shape_a = shapes[c.shape_a].shape(), &shape_b = shapes[c.shape_b].shape();
    const Transform<D> b_in_a = relative(frame(a, ma), frame(b, mb));
    Manifold<D> m =
        manifold_between<D>(shape_a, shape_b, c.facet, b_in_a, reach, narrow<double>(cache.normal));
    if (c.on_fixed && m.count > 1) lay_on_fixed_face(m, c, b_in_a);
    cache.pose = RelativePose<D>(a, b);
    cache.normal = narrow<float>(m.normal);
    cache.normal_of = m.normal_of;
    const bool flat = is_flat(shape_a) && is_flat(shape_b);
    if (m.normal_of == NormalOf::neither || !flat) {
        cache.way *= reuse_without_face;
        cache.turn *= reuse_without_face;
    }
    cache.roundness_a = static_cast<float>(roundness<D>(shape_a, m.normal));
    cache.roundness_b = static_cast<float>(roundness<D>(shape_b, unrotate(b_in_a.rotation, m.normal)));
    cache.count = m.count;
    if (m.count == 0) cache.gap = static_cast<float>(m.points[0].separation);
    for (int i = 0; i < m.count; ++i) {
        const Vec<D> on_a = m.points[i].position - ma.center;
        const Vec<D> on_b = unrotate(cache.pose.rotation, on_a - cache.pose.position);
        cache.points[i] = {on_a, on_b, static_cast<float>(m.points[i].separation), m.points[i].feature};
    }
}

/// Writes the points of the cache, carried along with the bodies, into the contact. A point lies midway
/// between its two marks, and its gap grows by what they part along the normal.
template <int D>
void WorldState<D>::set_points(const ContactCache<D>& cache, const BodyState<D>& a, const BodyState<D>& b,
                               double reach, ContactRecord<D>& c) const {
    const Vec<D> found = narrow<double>(cache.normal);
    const Vec<D> normal = cache.normal_of == NormalOf::second
                              ? rotate(b.rotation, unrotate(cache.pose.rotation, found))
                              : rotate(a.rotation, found);
    const Vec<D> between = b.position - a.position;
    c.normal = narrow<float>(normal);
    c.roundness_a = cache.roundness_a;
    c.roundness_b = cache.roundness_b;
    c.count = 0;
    for (int i = 0; i < cache.count; ++i) {
        const auto& mark = cache.points[i];
        const Vec<D> on_a = rotate(a.rotation, mark.on_a);
        const Vec<D> on_b = between + rotate(b.rotation, mark.on_b);
        const double separation = mark.separation + dot(normal, on_b - on_a);
        if (separation > reach) continue;
        const Vec<D> middle = 0.5 * (on_a + on_b);
        ContactRecordPoint<D>& p = c.points[c.count];
        p.arm_a = narrow<float>(middle);
        p.arm_b = narrow<float>(middle - between);
        p.separation = static_cast<float>(separation);
        p.impulse = p.total_impulse = 0;
        p.feature = mark.feature;
        if (!c.on_fixed || !is_artefact_of_seam(c, a, b, middle, separation)) ++c.count;
    }
}

/// Does it count for these two shapes, while they are apart, where a third may throw them within the step? Of
/// other shapes than balls the point at which they would touch cannot be told from far.
template <int D>
bool WorldState<D>::may_be_struck(const ContactRecord<D>& c) const {
    const auto is_simple = [&](std::uint32_t shape) {
        const ShapeKind kind = shapes[shape].shape().kind;
        return kind == ShapeKind::ball || kind == ShapeKind::plane;
    };
    return c.restitution >= static_cast<float>(lively_restitution) && definition.continuous &&
           is_simple(c.shape_a) && is_simple(c.shape_b);
}

/// One of the bodies may be struck by another within the step and then come here.
template <int D>
void WorldState<D>::meet_struck(ContactRecord<D>& c, ContactCache<D>& cache, double reach, double dt) const {
    const auto is_alone = [&](std::uint32_t body) {
        int others = 0;
        if (types[body] != BodyType::fixed) each_contact_of(body, [&](std::uint32_t) { ++others; });
        return others < 2;
    };
    if (is_alone(c.body_a) && is_alone(c.body_b)) return;
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const double way = dt * (length(sa.velocity) + length(sb.velocity)) + speculative_distance;
    const double far = std::min(way, smaller_radius(ma, mb));
    if (far <= reach || cache.least_gap(RelativePose<D>(sa, sb), mb.radius) > far) return;
    touch(c, sa, sb, far, cache);
    set_points(cache, sa, sb, far, c);
    if (c.count > 0) cache.forget();
}

template <int D>
void WorldState<D>::update_contact(ContactRecord<D>& c, ContactCache<D>& cache, double dt) const {
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const double way = dt * (length(sb.velocity - sa.velocity) + turning_speed(sa, ma) +
                             turning_speed(sb, mb) + length(definition.gravity) * dt);
    const double reach = definition.continuous ? speculative_distance : speculative_distance + way;
    const RelativePose<D> pose(sa, sb);
    const double least_gap = cache.least_gap(pose, mb.radius);
    const bool is_slow = !definition.continuous || way <= 0.5 * speculative_distance;
    const bool idle = c.count == 0 && !c.merged && !c.special && !may_be_struck(c);
    if (idle && is_slow && least_gap > reach) return;
    const ContactRecord<D> old = c;
    if (least_gap <= reach && !cache.holds(pose)) {
        // Points that are out of reach by less than the bodies may move before this is done again count too.
        const double radius = smaller_radius(ma, mb);
        cache.way = static_cast<float>(std::min(reuse_share * radius, reuse_way));
        cache.turn = static_cast<float>(cache.way / radius);
        touch(c, sa, sb, reach + cache.way, cache);
        // Round shapes roll away from their marks; and without continuous collision the reach is this step's.
        const bool round = cache.roundness_a != 0 || cache.roundness_b != 0;
        if ((round && cache.count > 0) || !definition.continuous) cache.forget();
    }
    set_points(cache, sa, sb, reach, c);
    if (c.count == 0 && !is_slow) {
        meet_ahead(c, cache, dt);
        if (c.count > 0) cache.forget();  // these points are of another time
    }
    if (c.count == 0 && may_be_struck(c)) meet_struck(c, cache, reach, dt);
    if (c.special) {
        pass_one_way(c, old.count > 0 || old.passing);
        drag_along(c);
    }
    carry_impulses(old, c, near_share * std::min(ma.radius, mb.radius), ma.inverse_mass == 0);
    c.total_friction = {};
    c.merged = false;
}

namespace {

/// Asks for all that the object is made of to be brought near.
template <class T>
void fetch_ahead(const T& object) {
    constexpr std::size_t line = 64;
    for (std::size_t i = 0; i < sizeof object; i += line)
        __builtin_prefetch(reinterpret_cast<const char*>(&object) + i);
}

}  // namespace

template <int D>
void WorldState<D>::collide(double dt) {
    // Those that are found now come straight from the solver; what it knows of them is read side by side.
    const std::size_t first_found = loose.size();
    solver.refresh(states, lane_shapes, static_cast<float>(speculative_distance), scheduler.get(),
                   [&](std::uint32_t i) {
                       if (contacts[i].loose != ContactRecord<D>::nowhere) return;
                       contacts[i].loose = static_cast<std::uint32_t>(loose.size());
                       loose.push_back(i);
                   });
    const std::size_t found_end = loose.size();
    const ApartLimits<float> limits{static_cast<float>(speculative_distance),
                                    static_cast<float>(0.5 * speculative_distance), static_cast<float>(dt),
                                    static_cast<float>(length(definition.gravity) * dt * dt)};
    for (const std::uint32_t i : apart.find_near(states, lane_shapes, limits, scheduler.get())) loosen(i);
    list_patches();
    run_range(scheduler.get(), loose.size(), 32, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            // They lie anywhere, so what is needed soon is asked for now: first the contact, then its bodies.
            constexpr std::size_t soon = 2, later = 4;
            if (k + later < end) {
                fetch_ahead(contacts[loose[k + later]]);
                fetch_ahead(caches[loose[k + later]]);
            }
            if (k + soon < end) {
                const ContactRecord<D>& next = contacts[loose[k + soon]];
                for (const std::uint32_t body : {next.body_a, next.body_b}) {
                    fetch_ahead(states[body]);
                    fetch_ahead(masses[body]);
                }
            }
            ContactRecord<D>& c = contacts[loose[k]];
            if (first_found <= k && k < found_end) solver.read(caches[loose[k]], c);
            if (any_moves(c.body_a, c.body_b)) update_contact(c, caches[loose[k]], dt);
        }
    });
    merge_patches();
}

#define CAROM_INSTANTIATE(D)                                                                              \
    template void WorldState<D>::touch(const ContactRecord<D>&, const BodyState<D>&, const BodyState<D>&, \
                                       double, ContactCache<D>&) const;                                   \
    template void WorldState<D>::set_points(const ContactCache<D>&, const BodyState<D>&,                  \
                                            const BodyState<D>&, double, ContactRecord<D>&) const;        \
    template bool WorldState<D>::may_be_struck(const ContactRecord<D>&) const;                            \
    template void WorldState<D>::collide(double);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
