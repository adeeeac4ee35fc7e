#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/manifold/reduce.hpp"
#include "world/state.hpp"

// A body that lies on several fixed shapes which are flush, tiles of a floor or triangles of a mesh, lies on
// one plane. Its contacts with them are made one contact, with the points that one plane would have: so the
// body feels no difference when it moves on from one shape to the next, and the solver has less to do.

namespace carom::detail {

namespace {

/// Normals that differ by less than a thousandth of a radian belong to one plane.
constexpr float same_normal_cosine = 1 - 5e-7f;

/// Points of different shapes that are nearer than this share of the body's radius are one.
constexpr double same_point_share = 1e-3;

/// A contact with a fixed shape as the moving body sees it.
template <int D>
struct View {
    bool on_a;             ///< is a the moving body?
    Vec<D, float> normal;  ///< out of the fixed shape
    float roundness;       ///< of the fixed shape

    View(const ContactRecord<D>& c, bool body_is_a)
        : on_a(body_is_a),
          normal(body_is_a ? -c.normal : c.normal),
          roundness(body_is_a ? c.roundness_b : c.roundness_a) {}
};

}  // namespace

template <int D>
void WorldState<D>::list_fixed_contact(std::uint32_t contact) {
    const ContactRecord<D>& c = contacts[contact];
    const bool a_moves = mover(c) == c.body_a;
    fixed_contacts.push_back(
        {mover(c), a_moves ? c.shape_a : c.shape_b, a_moves ? c.shape_b : c.shape_a, c.facet, contact});
}

/// Lists the contacts with fixed shapes of these bodies, which ascend, in the order of bodies and shapes.
template <int D>
void WorldState<D>::list_fixed_contacts(std::span<const std::uint32_t> bodies) {
    fixed_contacts.clear();
    for (const std::uint32_t body : bodies) {
        const std::size_t first = fixed_contacts.size();
        each_contact_of(body, true, [&](std::uint32_t contact) { list_fixed_contact(contact); });
        sort_fixed_contacts(first);
    }
}

/// Those from `first` on, which are all of one body.
template <int D>
void WorldState<D>::sort_fixed_contacts(std::size_t first) {
    std::sort(fixed_contacts.begin() + static_cast<std::ptrdiff_t>(first), fixed_contacts.end(),
              [](const FixedContact& a, const FixedContact& b) {
                  return std::tie(a.shape, a.other, a.facet) < std::tie(b.shape, b.other, b.facet);
              });
}

/// Lists the contacts with fixed shapes of bodies that have several and may touch one, and what they were.
/// Those that are known to be apart count as well: the surface goes on there.
template <int D>
void WorldState<D>::list_patches() {
    for (const std::uint32_t i : loose) {
        const ContactRecord<D>& c = contacts[i];
        if (c.on_fixed && moving[mover(c)] == moves_freely && fixed_contacts_of[mover(c)] > 1)
            picked.push_back(mover(c));
    }
    std::ranges::sort(picked);
    picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
    list_fixed_contacts(picked);
    picked.clear();

    // Only a shape that has several needs to know what they were.
    patches_before.clear();
    each_fixed_group([&](std::span<const FixedContact> group) {
        for (const FixedContact& member : group) {
            if (contacts[member.contact].count > 0) patches_before.push_back(contacts[member.contact]);
        }
    });
}

/// Calls `visit` with the contacts of every shape that has more than one with fixed shapes.
template <int D>
template <class Visit>
void WorldState<D>::each_fixed_group(const Visit& visit) const {
    for (auto first = fixed_contacts.begin(); first != fixed_contacts.end();) {
        const auto last = std::find_if(first, fixed_contacts.end(),
                                       [&](const FixedContact& c) { return c.shape != first->shape; });
        if (last - first > 1) visit(std::span<const FixedContact>(first, last));
        first = last;
    }
}

template <int D>
void WorldState<D>::merge_patches() {
    std::size_t earlier = 0;  // in `patches_before`, which has the order of the groups
    each_fixed_group([&](std::span<const FixedContact> group) {
        const std::size_t begin = earlier;
        while (earlier < patches_before.size() && (patches_before[earlier].shape_a == group[0].shape ||
                                                   patches_before[earlier].shape_b == group[0].shape))
            ++earlier;
        merge_group(group, std::span(patches_before).subspan(begin, earlier - begin));
    });
}

/// Contacts of the group with the same normal and the same surface become one: the one that was it in the
/// last step, or the first. Its points take up the impulses of the patch that was there before.
template <int D>
void WorldState<D>::merge_group(std::span<const FixedContact> group,
                                std::span<const ContactRecord<D>> before_step) {
    const std::uint32_t body = group[0].body;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const ContactRecord<D>& leader = contacts[group[i].contact];
        if (leader.count == 0) continue;
        const View<D> seen(leader, leader.body_a == body);
        const auto belongs = [&](const ContactRecord<D>& c) {
            const View<D> other(c, c.body_a == body);
            const Vec<D, float> drag = seen.on_a == other.on_a ? c.surface_velocity : -c.surface_velocity;
            return c.count > 0 && dot(seen.normal, other.normal) > same_normal_cosine &&
                   c.friction == leader.friction && c.restitution == leader.restitution &&
                   c.rolling == leader.rolling && drag == leader.surface_velocity &&
                   seen.roundness == other.roundness;
        };
        patch_members.clear();
        for (std::size_t k = i; k < group.size(); ++k) {
            if (belongs(contacts[group[k].contact])) patch_members.push_back(group[k].contact);
        }
        if (patch_members.size() > 1) merge_members(body, before_step);
    }
}

template <int D>
void WorldState<D>::merge_members(std::uint32_t body, std::span<const ContactRecord<D>> before_step) {
    const auto was_patch = [&](const ContactRecord<D>& c) {
        return std::ranges::any_of(before_step, [&](const ContactRecord<D>& old) {
            return old.shape_a == c.shape_a && old.shape_b == c.shape_b && old.facet == c.facet &&
                   dot(old.normal, c.normal) > same_normal_cosine;
        });
    };
    std::uint32_t chosen = patch_members[0];
    for (const std::uint32_t i : patch_members) {
        if (!was_patch(contacts[i])) continue;
        chosen = i;
        break;
    }
    ContactRecord<D>& patch = contacts[chosen];
    const bool on_a = patch.body_a == body;

    patch_points.clear();
    for (const std::uint32_t i : patch_members) {
        ContactRecord<D>& c = contacts[i];
        const bool c_on_a = c.body_a == body;
        c.nearest = c.points[0].separation;
        for (int k = 0; k < c.count; ++k) {
            const ContactRecordPoint<D>& p = c.points[k];
            c.nearest = std::min(c.nearest, p.separation);
            patch_points.push_back({narrow<double>(c_on_a ? p.arm_a : p.arm_b), p.separation, p.feature});
        }
        c.merged = i != chosen;
        if (c.merged) c.count = 0;
    }
    const std::size_t left = merge_points<D>(patch_points, same_point_share * masses[body].radius);
    const Manifold<D> manifold =
        manifold_of<D>(std::span(patch_points).first(left), narrow<double>(patch.normal));
    const Vec<D> between = states[patch.body_a].position - states[patch.body_b].position;
    patch.count = manifold.count;
    for (int k = 0; k < manifold.count; ++k) {
        const ManifoldPoint<D>& from = manifold.points[k];
        ContactRecordPoint<D>& p = patch.points[k];
        p = {};
        p.arm_a = narrow<float>(on_a ? from.position : from.position - between);
        p.arm_b = narrow<float>(on_a ? from.position + between : from.position);
        p.separation = static_cast<float>(from.separation);
        p.feature = from.feature;
    }
    for (const ContactRecord<D>& old : before_step) {
        const ContactRecord<D> turned = (old.body_a == body) == on_a ? old : exchanged(old);
        if (dot(turned.normal, patch.normal) <= same_normal_cosine) continue;
        carry_impulses(turned, patch, near_share * masses[body].radius, !on_a);
        break;
    }
}

#define CAROM_INSTANTIATE(D)                                                          \
    template void WorldState<D>::list_fixed_contact(std::uint32_t);                   \
    template void WorldState<D>::sort_fixed_contacts(std::size_t);                    \
    template void WorldState<D>::list_fixed_contacts(std::span<const std::uint32_t>); \
    template void WorldState<D>::list_patches();                                      \
    template void WorldState<D>::merge_patches();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
