#include "fuzz/pair_case.hpp"

#include <sstream>

#include "carom/error.hpp"
#include "collision/manifold.hpp"

#include "collision/sample.hpp"

namespace carom::test {

namespace {

template <int D>
Rotation<D> tremble(Random& random) {
    const double sizes[] = {0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
    const double angle = sizes[random.below(6)];
    if constexpr (D == 2)
        return Rotation2::from_angle(angle);
    else
        return Rotation3::from_axis_angle(random.direction<3>(), angle);
}

template <int D>
class PairCase {
  public:
    PairCase(int kind_a, int kind_b, std::uint64_t n);

    Findings findings(int placements);

  private:
    void bring_together(Random& random);
    void place_anew();
    void move_to_gap(const Separation<D>& apart, double gap);
    double gap_along(const Vec<D>& axis) const { return -b_.reach(-axis) - a_.reach(axis); }
    /// Gaps that differ from the reach by less may be found to be on either side of it.
    double doubt() const { return 1e-6 * small_ + tolerance_; }
    void expect(bool fine, const char* what, double is, double limit);
    void check_axis();
    void check_separation();
    void check_closest_points();
    void check_closest_points_quickly();
    void check_other_axes(int axes);
    void check_manifold();
    void check_points(const Manifold<D>& manifold, double reach);
    void check_placement();
    void check_placement_quickly();

    Random random_;
    Sample<D> a_, b_;
    double small_ = 0;      ///< size of the smaller shape
    double big_ = 0;        ///< size of the larger
    double exactness_ = 0;  ///< what distances may be off, but for a share of themselves
    double tolerance_ = 0;  ///< with that
    double rim_ = 0;        ///< size of the larger shape where one is a cylinder or cone, or zero
    Separation<D> found_{};
    std::ostringstream fault_;
};

constexpr double huge = 1e4, tiny = 1e-4;

double random_size(Random& random, bool far) {
    if (far) return 1;
    const double sizes[] = {1, 1, 1, huge, tiny};
    return sizes[random.below(5)] * random.between(0.3, 3);
}

double random_ratio(Random& random) {
    const double ratios[] = {1, 1, 1, 10, 1000};
    return ratios[random.below(5)] * random.between(0.5, 2);
}

template <int D>
PairCase<D>::PairCase(int kind_a, int kind_b, std::uint64_t n)
    : random_(1'000'003 * n + std::uint64_t(100 * kind_a + kind_b)),
      a_(random_sample<D>(kind_a, 1, random_)),
      b_(a_) {
    const bool far = random_.below(8) == 0;
    const Vec<D> base = far ? 1e7 * random_.direction<D>() : Vec<D>{};
    double a_size = random_size(random_, far), b_size = a_size * random_ratio(random_);
    if (random_.below(2)) std::swap(a_size, b_size);
    std::optional<Rotation<D>> turned;
    a_ = random_sample<D>(kind_a, a_size, random_, base);
    if (random_.below(3) == 0) turned = normalized(a_.placed.rotation * tremble<D>(random_));
    b_ = random_sample<D>(kind_b, b_size, random_, base, turned);
    small_ = a_.plane ? b_size : b_.plane ? a_size : std::min(a_size, b_size);
    big_ = std::max(a_size, b_size);
    if (kind_a > plane_kind<D> || kind_b > plane_kind<D>) rim_ = big_;
    // Far away positions are rounded to 2e-9 m.
    exactness_ = 1e-6 * small_ + 1e-8 * rim_ + 1e-12 * (a_size + b_size) + a_.vagueness + b_.vagueness +
                 (far ? 1e-8 : 0.0);
    bring_together(random_);
}

/// Leaves a gap of many sizes, or an overlap, along the axis of the first placement.
template <int D>
void PairCase<D>::bring_together(Random& random) {
    const double gaps[] = {0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.5, 3};
    const int choice = random.below(24);
    if (choice >= 20) return;
    const auto apart = separation<D>(a_.solid, a_.placed, b_.solid, b_.placed);
    if (apart) move_to_gap(*apart, (choice < 10 ? 1 : -1) * small_ * gaps[choice % 10]);
}

template <int D>
void PairCase<D>::move_to_gap(const Separation<D>& apart, double gap) {
    Sample<D>& moving = b_.plane ? a_ : b_;
    const Vec<D> way = (b_.plane ? -1.0 : 1.0) * (gap - apart.distance) * apart.axis;
    moving.move(way);
}

/// Every fourth placement is turned anew; from it one comes to others along the axis that it has.
template <int D>
void PairCase<D>::place_anew() {
    const double gaps[] = {0, 1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.3};
    if (random_.below(4)) {
        const int choice = random_.below(16);
        move_to_gap(found_, (choice < 8 ? 1 : -1) * small_ * gaps[choice % 8]);
        return;
    }
    Sample<D>& moving = b_.plane ? a_ : b_;
    const Rotation<D> turned =
        random_.below(4) == 0 ? moving.turned * tremble<D>(random_) : random_.rotation<D>();
    moving.place(normalized(turned), random_.in_cube<D>(0.7 * big_));
}

template <int D>
void PairCase<D>::expect(bool fine, const char* what, double is, double limit) {
    if (fine) return;
    fault_.precision(17);
    fault_ << what << ": " << is << " against " << limit << " (distance " << found_.distance
           << ", smaller size " << small_ << ")\n";
}

/// A distance hardly changes with its direction, which therefore is known to the root of the rounding alone,
/// and the gap along it to that share of the longer lever.
template <int D>
void PairCase<D>::check_axis() {
    expect(std::fabs(length(found_.axis) - 1) < 1e-9, "length of the axis", length(found_.axis), 1);
    const double gap = gap_along(found_.axis);
    expect(std::fabs(gap - found_.distance) <= tolerance_ + 2e-8 * big_, "gap along the axis", gap,
           found_.distance);
}

template <int D>
void PairCase<D>::check_separation() {
    const auto other = separation<D>(b_.solid, b_.placed, a_.solid, a_.placed);
    expect(std::fabs(other->distance - found_.distance) <= tolerance_, "distance with shapes exchanged",
           other->distance, found_.distance);
    const bool meets = overlap<D>(a_.solid, a_.placed, b_.solid, b_.placed);
    expect(meets == (found_.distance <= 0), "overlap", meets, found_.distance);
}

template <int D>
void PairCase<D>::check_closest_points() {
    const auto closest = closest_points<D>(a_.solid, a_.placed, b_.solid, b_.placed);
    const double distance = std::max(found_.distance, 0.0);
    // On rims that are thousands of times larger than the other shape it is right to 1e-7 of them.
    const double vague = tolerance_ + 2e-7 * rim_;
    expect(std::fabs(closest.distance - distance) <= vague, "closest distance", closest.distance, distance);
    expect(a_.height(closest.on_a) <= vague, "point of a above its surface", a_.height(closest.on_a), 0);
    expect(b_.height(closest.on_b) <= vague, "point of b above its surface", b_.height(closest.on_b), 0);
}

/// The same where points in the shapes are told by that they stand out along none of a few directions.
template <int D>
void PairCase<D>::check_closest_points_quickly() {
    const auto closest = closest_points<D>(a_.solid, a_.placed, b_.solid, b_.placed);
    const double distance = std::max(found_.distance, 0.0);
    const double vague = tolerance_ + 2e-7 * rim_;
    expect(std::fabs(closest.distance - distance) <= vague, "closest distance", closest.distance, distance);
    expect(std::fabs(length(closest.on_b - closest.on_a) - closest.distance) <= vague, "between the points",
           length(closest.on_b - closest.on_a), closest.distance);
    const auto check_inside = [&](const Sample<D>& shape, const Vec<D>& point, const Vec<D>& direction) {
        if (shape.plane) return;
        const double above = dot(direction, point - shape.base) - shape.reach(direction);
        expect(above <= vague, "closest point beyond the surface", above, 0);
    };
    check_inside(a_, closest.on_a, found_.axis);
    check_inside(b_, closest.on_b, -found_.axis);
    const Vec<D> direction = random_.direction<D>();
    check_inside(a_, closest.on_a, direction);
    check_inside(b_, closest.on_b, direction);
}

/// No axis may show a wider gap.
template <int D>
void PairCase<D>::check_other_axes(int axes) {
    if (a_.plane || b_.plane) return;
    for (int i = 0; i < axes; ++i) {
        constexpr double scales[] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
        const double scale = scales[random_.below(6)];
        const Vec<D> axis =
            3 * i < axes ? random_.direction<D>() : normalized(found_.axis + scale * random_.direction<D>());
        const double gap = gap_along(axis);
        expect(gap <= found_.distance + tolerance_, "gap along another axis", gap, found_.distance);
    }
}

/// The manifold must be there where the gap is less than the reach, and its deepest point as deep as that.
/// In space it may be off
/// - by 5 % of the depth and 1e-6 of the size for a direction that is preferred (`advantage`, nearest_3.hpp),
///   and by as much again and 1e-5 of a face for the patch over it (`Meeting::confirms`, patch_3.cpp);
/// - by 1e-4 of a face for corners that are that far from it and count as on it (`snap_share`);
/// - by 1 % of the depth or 5e-4 of the patch for a deepest point among more than four (`is_deeper`,
///   reduce.cpp).
/// A face of the smaller shape is 1.42 times as long as its size. In the plane parallel edges may be off by 5
/// % and 2 % of the shorter edge, which is 1.42 sizes long, and one may lead that is 1e-4 of an edge worse
/// (polygons_2.cpp).
template <int D>
void PairCase<D>::check_points(const Manifold<D>& manifold, double reach) {
    if (manifold.count == 0) {
        expect(found_.distance > reach - tolerance_, "no contact", found_.distance, reach);
        return;
    }
    expect(found_.distance <= reach + doubt(), "contact", found_.distance, reach);
    expect(std::fabs(length(manifold.normal) - 1) < 1e-9, "length of the normal", length(manifold.normal), 1);
    double least = 1e300;
    for (int i = 0; i < manifold.count; ++i) {
        const auto& point = manifold.points[std::size_t(i)];
        least = std::min(least, point.separation);
        expect(std::isfinite(length(point.position)), "a point", length(point.position), 0);
        expect(point.separation <= reach + 1e-12 * big_, "separation of a point", point.separation, reach);
    }
    const double slack = D == 2 ? 0.05 * std::fabs(found_.distance) + 0.0302 * small_ + tolerance_
                                : 0.1125 * std::fabs(found_.distance) + 8.7e-4 * small_ + tolerance_;
    expect(std::fabs(least - found_.distance) <= slack, "deepest point", least, found_.distance);
}

template <int D>
void PairCase<D>::check_manifold() {
    const double reach = random_.below(2) ? 0 : 0.05 * small_;
    const auto m = collide<D>(a_.solid, a_.placed, b_.solid, b_.placed, reach);
    const auto swapped = collide<D>(b_.solid, b_.placed, a_.solid, a_.placed, reach);
    check_points(m, reach);
    check_points(swapped, reach);
    if (std::fabs(found_.distance - reach) <= doubt()) return;
    expect((m.count > 0) == (swapped.count > 0), "contact with shapes exchanged", m.count, swapped.count);
    // An axis to begin with, good or bad, changes nothing.
    const Transform<D> b_in_a = relative(a_.placed, b_.placed);
    const detail::Shape<D>&a = a_.solid.shape(), &b = b_.solid.shape();
    const auto without = detail::collide_shapes<D>(a, b, b_in_a, reach);
    for (const Vec<D>& axis : {unrotate(a_.placed.rotation, found_.axis), random_.direction<D>()}) {
        const auto again = detail::collide_shapes<D>(a, b, b_in_a, reach, axis);
        expect(without.count == again.count, "points with an axis to begin with", again.count, without.count);
        if (without.count == 0 || without.count != again.count) continue;
        const double is = again.points[0].separation, was = without.points[0].separation;
        expect(again.normal == without.normal && is == was, "separation with an axis to begin with", is, was);
    }
}

template <int D>
void PairCase<D>::check_placement() {
    check_axis();
    check_separation();
    check_closest_points();
    check_other_axes(24);
    check_manifold();
}

template <int D>
void PairCase<D>::check_placement_quickly() {
    check_axis();
    check_closest_points_quickly();
    check_other_axes(3);
    const double reach = random_.below(2) ? 0 : 0.05 * small_;
    check_points(collide<D>(a_.solid, a_.placed, b_.solid, b_.placed, reach), reach);
}

template <int D>
Findings PairCase<D>::findings(int placements) {
    Findings findings;
    for (int k = 0; k < placements; ++k) {
        if (k > 0) place_anew();
        const auto found = separation<D>(a_.solid, a_.placed, b_.solid, b_.placed);
        expect(found.has_value(), "separation", 0, 1);
        if (found) {
            found_ = *found;
            // Depths are right to a share of themselves.
            tolerance_ = exactness_ + 1e-7 * std::fabs(found_.distance);
            k > 0 ? check_placement_quickly() : check_placement();
        }
        findings.count(k == 0);
        if (fault_.tellp() == 0) continue;
        findings.fault = fault_.str() + "placement " + std::to_string(k) + '\n';
        break;
    }
    return findings;
}

}  // namespace

template <int D>
Findings look_at_case(int kind_a, int kind_b, std::uint64_t n, int placements) {
    try {
        return PairCase<D>(kind_a, kind_b, n).findings(placements);
    } catch (const Error&) {
        return {};  // points without volume make no hull
    }
}

template Findings look_at_case<2>(int, int, std::uint64_t, int);
template Findings look_at_case<3>(int, int, std::uint64_t, int);

}  // namespace carom::test
