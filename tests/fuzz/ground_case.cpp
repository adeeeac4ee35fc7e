#include "fuzz/ground_case.hpp"

#include <limits>
#include <sstream>

#include "carom/error.hpp"
#include "collision/facet.hpp"
#include "collision/sample.hpp"

namespace carom::test {

namespace {

using detail::Facet;

/// A few segments or triangles, one beside the other, about as large as `size`.
Geometry<2> random_ground(Random& random, double size, std::type_identity<Geometry<2>>) {
    const int count = 2 + random.below(4);
    if (random.below(3) == 0) {
        HeightField<2> field{.heights = {}, .spacing = {size * random.between(0.3, 1)}};
        for (int i = 0; i < count; ++i) field.heights.push_back(random.between(-size, size));
        return field;
    }
    Chain chain;
    for (int i = 0; i < count; ++i) chain.points.push_back(random.in_cube<2>(size));
    chain.two_sided = random.below(2) == 0;
    return chain;
}

Geometry<3> random_ground(Random& random, double size, std::type_identity<Geometry<3>>) {
    if (random.below(3) == 0) {
        HeightField<3> field{.heights = {},
                             .spacing = {size * random.between(0.3, 1), size * random.between(0.3, 1)}};
        for (int row = 0; row < 2; ++row) {
            field.heights.emplace_back();
            for (int i = 0; i < 2; ++i)
                field.heights[std::size_t(row)].push_back(random.between(-size, size));
        }
        return field;
    }
    Mesh mesh;
    const std::uint32_t triangles = std::uint32_t(1 + random.below(4));
    while (mesh.vertices.size() < triangles + 2) {
        mesh.vertices.push_back(random.in_cube<3>(size));
        const std::size_t count = mesh.vertices.size();
        if (count < 3) continue;
        const Vec3* last = &mesh.vertices[count - 3];
        // No slivers: nobody can tell their normals.
        if (length(cross(last[1] - last[0], last[2] - last[0])) < 1e-3 * size * size)
            mesh.vertices.pop_back();
    }
    for (std::uint32_t i = 0; i < triangles; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
    mesh.two_sided = random.below(2) == 0;
    return mesh;
}

template <int D>
class GroundCase {
  public:
    GroundCase(int kind, std::uint64_t n);

    Findings findings(int places);

  private:
    const detail::Terrain<D>& terrain() const { return *ground_.shape().terrain; }
    /// The gap between a facet and the shape along an axis, all in the frame of the ground.
    double gap_along(const Facet<D>& facet, const Vec<D>& axis) const {
        double highest = -1e300;
        for (const Vec<D>& p : facet.points) highest = std::max(highest, dot(axis, p));
        return -shape_.reach(-axis) - highest;
    }
    void expect(bool fine, const char* what, double is, double limit);
    void bring_together();
    void place_anew();
    Findings look_at_all();
    void check_facet(const Facet<D>& facet);
    void check_gap(const Facet<D>& facet, const Separation<D>& found);
    void check_manifold(const Facet<D>& facet, const std::optional<Separation<D>>& found);

    Random random_;
    double ground_size_, size_;
    Solid<D> ground_;
    Sample<D> shape_;  ///< in the frame of the ground
    double small_, big_;
    bool is_revolved_;
    double tolerance_;
    bool thorough_ = true;  ///< against all oracles
    double nearest_ = std::numeric_limits<double>::infinity();
    bool doubtful_ = false;
    std::ostringstream fault_;
};

double size_beside(double size, Random& random) {
    const double ratios[] = {1, 1, 0.1, 0.01, 10, 100};
    return size * ratios[random.below(6)] * random.between(0.5, 2);
}

template <int D>
GroundCase<D>::GroundCase(int kind, std::uint64_t n)
    : random_(1'000'003 * n + std::uint64_t(500'000 + kind)),
      ground_size_(random_.between(0.3, 3)),
      size_(size_beside(ground_size_, random_)),
      ground_(random_ground(random_, ground_size_, std::type_identity<Geometry<D>>{})),
      shape_(random_sample<D>(kind, size_, random_)),
      small_(std::min(size_, ground_size_)),
      big_(std::max(size_, ground_size_)),
      is_revolved_(kind > plane_kind<D>),
      tolerance_(2e-6 * small_ + (is_revolved_ ? 1e-7 : 1e-9) * big_ + shape_.vagueness) {
    bring_together();
}

template <int D>
void GroundCase<D>::bring_together() {
    const double gaps[] = {0, 1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.5};
    const int choice = random_.below(20);
    const auto apart = separation<D>(ground_, {}, shape_.solid, shape_.placed);
    if (choice >= 16 || !apart) return;
    const double gap = (choice < 8 ? 1 : -1) * small_ * gaps[choice % 8];
    shape_.move((gap - apart->distance) * apart->axis);
}

template <int D>
void GroundCase<D>::place_anew() {
    shape_.place(random_.rotation<D>(), random_.in_cube<D>(0.7 * big_));
    bring_together();
}

template <int D>
void GroundCase<D>::expect(bool fine, const char* what, double is, double limit) {
    if (fine) return;
    fault_.precision(17);
    fault_ << what << ": " << is << " against " << limit << " (smaller size " << small_ << ", larger " << big_
           << ")\n";
}

template <int D>
void GroundCase<D>::check_gap(const Facet<D>& facet, const Separation<D>& found) {
    const double exact = tolerance_ + 1e-7 * std::fabs(found.distance);
    expect(std::fabs(length(found.axis) - 1) < 1e-9, "length of the axis", length(found.axis), 1);
    const double gap = gap_along(facet, found.axis);
    expect(std::fabs(gap - found.distance) <= exact, "gap along the axis", gap, found.distance);
    const Vec<D> front = facet.normal();
    if (!facet.two_sided) expect(dot(found.axis, front) > -3e-6, "looks back", dot(found.axis, front), 0);
    const auto compare = [&](const Vec<D>& axis) {
        const double other = gap_along(facet, axis);
        expect(other <= found.distance + exact, "gap along another axis", other, found.distance);
    };
    // What overlaps a facet with one side leaves it straight forwards or by a face that does not lead back.
    const detail::Shape<D>& shape = shape_.solid.shape();
    if (!facet.two_sided && found.distance + detail::core_radius(shape) <= exact) {
        compare(front);
        if (!shape.core) return;
        for (const Vec<D>& normal : shape.core->normals) {
            const Vec<D> axis = -rotate(shape_.placed.rotation, normal);
            if (dot(axis, front) >= 0) compare(axis);
        }
        return;
    }
    const int axes = thorough_ ? 24 : 3;
    for (int i = 0; i < axes; ++i) {
        constexpr double scales[] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
        const double scale = scales[random_.below(6)];
        compare(3 * i < axes ? random_.direction<D>()
                             : normalized(found.axis + scale * random_.direction<D>()));
    }
}

template <int D>
void GroundCase<D>::check_manifold(const Facet<D>& facet, const std::optional<Separation<D>>& found) {
    const double reach = random_.below(2) ? 0 : 0.05 * small_;
    const detail::Shape<D>& shape = shape_.solid.shape();
    const auto m = detail::collide_facet<D>(shape, facet, shape_.placed, reach);
    const double distance = found ? found->distance : std::numeric_limits<double>::infinity();
    const double doubt = 2e-5 * small_ + 1e-5 * big_ + tolerance_;
    if (m.count > 0) {
        // Where the axis is all but sideways, the manifold's may lead forwards.
        const bool sideways = !found || std::fabs(dot(found->axis, facet.normal())) < 0.05;
        expect(distance <= reach + doubt || (!facet.two_sided && sideways), "contact", distance, reach);
        expect(std::fabs(length(m.normal) - 1) < 1e-9, "length of the normal", length(m.normal), 1);
        double least = 1e300;
        for (int i = 0; i < m.count; ++i) {
            const auto& point = m.points[std::size_t(i)];
            least = std::min(least, point.separation);
            expect(std::isfinite(length(point.position)), "a point", length(point.position), 0);
            expect(point.separation <= reach + 1e-12 * big_, "separation of a point", point.separation,
                   reach);
        }
        const double slack = 0.11 * std::fabs(distance) + 2e-3 * small_ + 1e-5 * big_ + tolerance_ +
                             (D == 2 ? 0.03 * small_ : 0.0);
        // Where the shortest way of all leads back, a cylinder or cone takes one of a few likely ways.
        const bool likely = is_revolved_ && !facet.two_sided && found && found->distance <= 0;
        if (found && !likely) expect(std::fabs(least - distance) <= slack, "deepest point", least, distance);
    } else if (found && (facet.two_sided || dot(found->axis, facet.normal()) > 0.05)) {
        expect(distance > reach - tolerance_, "no contact", distance, reach);
    }
    // An axis to begin with may show at once that they are apart, which no other one may deny.
    if (!thorough_ || std::fabs(distance - reach) <= doubt) return;
    for (const Vec<D>& axis : {m.normal, random_.direction<D>()}) {
        const auto again = detail::collide_facet<D>(shape, facet, shape_.placed, reach, axis);
        const bool same = (m.count > 0) == (again.count > 0);
        expect(same || distance > reach, "contact with an axis to begin with", again.count, m.count);
    }
}

template <int D>
void GroundCase<D>::check_facet(const Facet<D>& facet) {
    const auto found = detail::separate_facet(shape_.solid.shape(), facet, shape_.placed);
    expect(found || !facet.two_sided, "a facet with two sides is not met", 0, 1);
    if (found) {
        nearest_ = std::min(nearest_, found->distance);
        check_gap(facet, *found);
    }
    if (facet.two_sided) return;
    // Whether the shape is in front, whether its way leads back, and which way that is where they only just
    // touch, may be a matter of rounding.
    const double height =
        dot(facet.normal(), apply(shape_.placed, detail::middle_of(shape_.solid.shape())) - facet.points[0]);
    Facet<D> both = facet;
    both.two_sided = true;
    const auto free = detail::separate_facet(shape_.solid.shape(), both, shape_.placed);
    const double cores = free->distance + detail::core_radius(shape_.solid.shape());
    if (std::fabs(height) <= tolerance_ || std::fabs(cores) <= tolerance_ ||
        std::fabs(free->distance) <= tolerance_)
        doubtful_ = true;
    if (std::fabs(dot(free->axis, facet.normal())) < 1e-5) doubtful_ = true;
    check_manifold(facet, found);
}

template <int D>
Findings GroundCase<D>::look_at_all() {
    Findings findings;
    nearest_ = std::numeric_limits<double>::infinity();
    doubtful_ = false;
    terrain().query(terrain().bounds(), [&](std::uint32_t i) {
        check_facet(terrain().facet(i));
        findings.count(thorough_);
    });
    const auto whole = separation<D>(ground_, {}, shape_.solid, shape_.placed);
    if (!doubtful_) {
        expect(whole.has_value() == (nearest_ < 1e300), "separation from all", whole.has_value(), nearest_);
        if (whole)
            expect(std::fabs(whole->distance - nearest_) <= tolerance_, "distance of all", whole->distance,
                   nearest_);
    }
    return findings;
}

template <int D>
Findings GroundCase<D>::findings(int places) {
    Findings findings;
    for (int k = 0; k < places; ++k) {
        thorough_ = k == 0;
        if (k > 0) place_anew();
        findings += look_at_all();
        if (fault_.tellp() == 0) continue;
        findings.fault = fault_.str() + "place " + std::to_string(k) + '\n';
        break;
    }
    return findings;
}

}  // namespace

template <int D>
Findings look_at_ground_case(int kind, std::uint64_t n, int places) {
    try {
        return GroundCase<D>(kind, n).findings(places);
    } catch (const Error&) {
        return {};  // points without volume make no hull
    }
}

template Findings look_at_ground_case<2>(int, std::uint64_t, int);
template Findings look_at_ground_case<3>(int, std::uint64_t, int);

}  // namespace carom::test
