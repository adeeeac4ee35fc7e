#include "solver/contact_store.hpp"

#include <cmath>

#include "solver/prepare.hpp"
#include "solver/split_pose.hpp"

namespace carom::detail {

namespace {

/// Fields of the marks.
template <int D>
struct MarkFields {
    static constexpr ContactMarks<D, float> model{};
    static std::size_t way() { return field_of(model, model.way_squared); }
    static std::size_t restitution() { return field_of(model, model.restitution); }
    static std::size_t touching() { return field_of(model, model.touching); }
    static std::size_t can_be_remade() { return field_of(model, model.can_be_remade); }
    static std::size_t is_newer() { return field_of(model, model.is_newer); }
};

float lane_feature(std::uint32_t feature) {
    constexpr std::uint32_t first_inexact = 1u << 24;
    return feature < first_inexact ? static_cast<float>(feature) : -1.0f;
}

template <int D>
ContactMarks<D, float> marks_of(const ContactCache<D>& cache) {
    ContactMarks<D, float> marks;
    set_pose(cache.pose, marks.place, marks.place_rest, marks.turn, marks.turn_rest);
    const bool of_b = cache.normal_of == NormalOf::second;
    marks.normal =
        of_b ? narrow<float>(unrotate(cache.pose.rotation, narrow<double>(cache.normal))) : cache.normal;
    marks.is_of_b = of_b ? 1.0f : 0.0f;
    for (int k = 0; k < max_points<D>; ++k) {
        const auto& from = cache.points[k];
        const bool there = k < cache.count;
        marks.points[k].on_a = there ? narrow<float>(from.on_a) : Vec<D, float>{};
        marks.points[k].on_b = there ? narrow<float>(from.on_a - cache.pose.position) : Vec<D, float>{};
        marks.points[k].separation = there ? from.separation : no_separation;
        marks.points[k].feature = lane_feature(from.feature);
    }
    marks.way_squared = cache.way < 0 ? -1 : cache.way * cache.way;
    marks.turn_squared = cache.turn * cache.turn;
    return marks;
}

/// What the lanes made anew, the points in the order in which they are there.
template <int D>
ContactCache<D> cache_of(const ContactMarks<D, float>& marks, float roundness_a, float roundness_b) {
    ContactCache<D> cache;
    cache.pose = pose_of(marks.place, marks.place_rest, marks.turn, marks.turn_rest);
    const bool of_b = marks.is_of_b != 0;
    cache.normal =
        of_b ? narrow<float>(rotate(cache.pose.rotation, narrow<double>(marks.normal))) : marks.normal;
    cache.normal_of = of_b ? NormalOf::second : NormalOf::first;
    for (const auto& mark : marks.points) {
        auto& p = cache.points[cache.count++];
        p.on_a = narrow<double>(mark.on_a);
        p.on_b = unrotate(cache.pose.rotation, p.on_a - cache.pose.position);
        p.separation = mark.separation;
        p.feature = static_cast<std::uint32_t>(mark.feature);
    }
    cache.roundness_a = roundness_a;
    cache.roundness_b = roundness_b;
    cache.way = marks.way_squared < 0 ? -1 : std::sqrt(marks.way_squared);
    cache.turn = std::sqrt(marks.turn_squared);
    return cache;
}

/// All rows but the points.
template <int D>
ContactRows<D, float> rows_of(const ContactRecord<D>& record) {
    ContactRows<D, float> rows;
    set_normal(rows, record.normal);
    const auto t = frame_of(rows).tangents;
    for (int i = 0; i < D - 1; ++i) {
        rows.friction_impulse[i] = dot(record.friction_impulse, t[i]);
        rows.surface_speed[i] = dot(record.surface_velocity, t[i]);
    }
    rows.friction = record.friction;
    if constexpr (D == 3) rows.twist_impulse = record.twist_impulse;
    rows.roundness_a = record.roundness_a;
    rows.roundness_b = record.roundness_b;
    rows.rolling = record.rolling;
    rows.rolling_impulse = record.spin_impulse;
    return rows;
}

/// Where the points of a contact are, seen from either body.
template <int D>
struct Arms {
    std::array<Vec<D, float>, max_points<D>> a{}, b{};
};

template <int D>
void set_point(NormalRow<D, float>& row, Arms<D>& arms, int k, const ContactRecordPoint<D>& from) {
    arms.a[k] = from.arm_a;
    arms.b[k] = from.arm_b;
    row.separation = from.separation;
    row.impulse = from.impulse;
    row.mass = 1;  // used; see `weigh_rows`
}

}  // namespace

template <int D>
void ContactStore<D>::set_passes(const Passes<D>& passes) {
    passes_ = &passes;
    rows_.set_width(passes.width);
    marks_.set_width(passes.width);
}

template <int D>
std::uint32_t ContactStore<D>::push(std::uint32_t contact, const BodyPair& bodies,
                                    std::uint32_t first_movable) {
    const auto index = static_cast<std::uint32_t>(size_++);
    if (index % width() == 0) {
        const std::size_t lanes = index + width();
        rows_.resize(lanes / width());
        marks_.resize(lanes / width());
        a_.resize(lanes, nobody);
        b_.resize(lanes, nobody);
        body_a_.resize(lanes, 0);
        body_b_.resize(lanes, 0);
        shape_a_.resize(lanes, LaneShapes<D>::none);
        shape_b_.resize(lanes, LaneShapes<D>::none);
        contact_.resize(lanes, none);
        traits_.push_back(0);
        found_.push_back(0);
        for (std::size_t lane = index; lane < lanes; ++lane) clear(static_cast<std::uint32_t>(lane));
    }
    a_[index] = record_of<D>(bodies.slot_a);
    b_[index] = record_of<D>(bodies.slot_b);
    body_a_[index] = bodies.body_a;
    body_b_[index] = bodies.body_b;
    contact_[index] = contact;
    mark_fixed(index / width(), first_movable);
    return index;
}

template <int D>
std::uint32_t ContactStore<D>::remove(std::uint32_t index, std::uint32_t first_movable) {
    const auto last = static_cast<std::uint32_t>(--size_);
    std::uint32_t moved = none;
    if (index != last) {
        moved = contact_[last];
        rows_.set(index, rows_.get(last));
        marks_.set(index, marks_.get(last));
        a_[index] = a_[last];
        b_[index] = b_[last];
        body_a_[index] = body_a_[last];
        body_b_[index] = body_b_[last];
        shape_a_[index] = shape_a_[last];
        shape_b_[index] = shape_b_[last];
        contact_[index] = moved;
        traits_[index / width()] |= traits_[last / width()];
        mark_fixed(index / width(), first_movable);
    }
    if (last % width() == 0) {
        a_.resize(last);
        b_.resize(last);
        body_a_.resize(last);
        body_b_.resize(last);
        shape_a_.resize(last);
        shape_b_.resize(last);
        contact_.resize(last);
        traits_.pop_back();
        found_.pop_back();
    } else {
        clear(last);
        mark_fixed(last / width(), first_movable);
    }
    return moved;
}

template <int D>
void ContactStore<D>::clear(std::uint32_t index) {
    rows_.set(index, {});
    Marks marks;
    marks.way_squared = -1;
    marks_.set(index, marks);
    a_[index] = b_[index] = nobody;
    body_a_[index] = body_b_[index] = 0;
    shape_a_[index] = shape_b_[index] = LaneShapes<D>::none;
    contact_[index] = none;
}

/// Does any lane of the block have a body that cannot be pushed, be it nobody?
template <int D>
void ContactStore<D>::mark_fixed(std::size_t block, std::uint32_t first_movable) {
    bool fixed = false;
    for (std::size_t lane = block * width(); lane < (block + 1) * width(); ++lane)
        fixed |= slot_of<D>(a_[lane]) < first_movable || slot_of<D>(b_[lane]) < first_movable;
    traits_[block] = static_cast<std::uint8_t>((traits_[block] & ~some_fixed) | (fixed ? some_fixed : 0));
}

template <int D>
void ContactStore<D>::write(std::uint32_t index, const ContactRecord<D>& record,
                            const Carrying<D>* carrying) {
    Rows rows = rows_of(record);
    Arms<D> arms;
    Marks marks;
    if (carrying && carrying->cache.count > 0) {
        const ContactCache<D>& cache = carrying->cache;
        marks = marks_of(cache);
        int next = 0;  // the record has those of the cache's points that are within reach, in their order
        for (int k = 0; k < cache.count && next < record.count; ++k) {
            if (record.points[next].feature == cache.points[k].feature)
                set_point(rows.points[k], arms, k, record.points[next++]);
        }
    } else {
        marks.way_squared = -1;
        for (int k = 0; k < record.count; ++k) {
            set_point(rows.points[k], arms, k, record.points[k]);
            marks.points[k].on_a.x = marks.points[k].on_b.x = unknown_place;
            marks.points[k].feature = lane_feature(record.points[k].feature);
        }
    }
    place_points(rows, frame_of(rows), arms.a, arms.b);
    const LanePair<D> shapes = carrying ? carrying->shapes : LanePair<D>{};
    marks.can_be_remade = shapes ? 1.0f : 0.0f;
    shape_a_[index] = shapes.a;
    shape_b_[index] = shapes.b;
    marks.restitution = record.restitution;
    marks.touching = record.touching ? 1.0f : 0.0f;
    rows_.set(index, rows);
    marks_.set(index, marks);
    std::uint8_t& traits = traits_[index / width()];
    if (record.rolling > 0) traits |= some_rolling;
    if (record.roundness_a != 0 || record.roundness_b != 0) traits |= some_round;
    if (rows.surface_speed != decltype(rows.surface_speed){}) traits |= some_belts;
    if (record.restitution == 0) return;
    traits |= some_bouncy;
    some_bounce_ = true;
}

template <int D>
void ContactStore<D>::read(std::uint32_t index, ContactCache<D>& cache, ContactRecord<D>& record) const {
    const Rows rows = rows_.get(index);
    if (marks_.at(index, MarkFields<D>::is_newer()) != 0)
        cache = cache_of(marks_.get(index), rows.roundness_a, rows.roundness_b);
    record.touching = marks_.at(index, MarkFields<D>::touching()) != 0;
    record.normal = rows.normal;
    record.friction_impulse = along_tangents(rows, rows.friction_impulse);
    record.total_friction = along_tangents(rows, rows.total_friction);
    if constexpr (D == 3) record.twist_impulse = rows.twist_impulse;
    record.spin_impulse = rows.rolling_impulse;
    const bool carried = cache.count > 0 && is_carried(index);
    const int count = carried ? cache.count : record.count;
    if (carried) record.count = 0;
    for (int k = 0; k < count; ++k) {
        const NormalRow<D, float>& row = rows.points[k];
        if (carried && !(row.mass > 0)) continue;
        ContactRecordPoint<D>& p = record.points[carried ? record.count++ : k];
        if (carried) p.feature = cache.points[k].feature;
        p.arm_a = arm_a(rows, row);
        p.arm_b = arm_b(rows, row);
        p.separation = row.separation;
        p.impulse = row.impulse;
        p.total_impulse = row.total_impulse;
    }
}

template <int D>
bool ContactStore<D>::is_carried(std::uint32_t index) const {
    return marks_.at(index, MarkFields<D>::way()) >= 0 ||
           marks_.at(index, MarkFields<D>::can_be_remade()) != 0;
}

template <int D>
float ContactStore<D>::restitution(std::uint32_t index) const {
    return marks_.at(index, MarkFields<D>::restitution());
}

template <int D>
BlockSpan<D> ContactStore<D>::span(std::size_t first, std::size_t count) {
    const std::size_t lane = first * width();
    return {rows_.data() + lane * LaneStore<Rows>::fields,
            marks_.data() + lane * LaneStore<Marks>::fields,
            a_.data() + lane,
            b_.data() + lane,
            body_a_.data() + lane,
            body_b_.data() + lane,
            shape_a_.data() + lane,
            shape_b_.data() + lane,
            traits_.data() + first,
            found_.data() + first,
            count};
}

template class ContactStore<2>;
template class ContactStore<3>;

}  // namespace carom::detail
