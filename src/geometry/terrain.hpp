#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "carom/shapes.hpp"
#include "geometry/facet_tree.hpp"
#include "geometry/height_grid.hpp"

namespace carom::detail {

/// A segment or a triangle of a terrain. What is behind it is solid, unless it is two-sided; in front is what
/// lies to the left of a segment's direction, and from where a triangle's corners run counter-clockwise.
template <int D>
struct Facet {
    std::array<Vec<D>, D> points;
    bool two_sided = false;

    /// Unit vector out of the solid.
    Vec<D> normal() const {
        if constexpr (D == 2) {
            const Vec2 along = normalized(points[1] - points[0]);
            return {-along.y, along.x};
        } else {
            return normalized(cross(points[1] - points[0], points[2] - points[0]));
        }
    }
    Aabb<D> bounds() const {
        Aabb<D> box{points[0], points[0]};
        for (const Vec<D>& p : points) {
            for (int i = 0; i < D; ++i) {
                box.lower[i] = std::min(box.lower[i], p[i]);
                box.upper[i] = std::max(box.upper[i], p[i]);
            }
        }
        return box;
    }
};

/// May the facet touch the box? Their bounds overlap, and the box does not lie on one side of the facet's
/// plane.
template <int D>
bool may_touch(const Facet<D>& facet, const Aabb<D>& box) {
    const Aabb<D> own = facet.bounds();
    bool overlap = true;  // never, where a corner is not a number
    for (int i = 0; i < D; ++i) overlap &= own.lower[i] <= box.upper[i] && box.lower[i] <= own.upper[i];
    if (!overlap) return false;
    const Vec<D> u = facet.points[1] - facet.points[0];
    Vec<D> across;
    if constexpr (D == 2)
        across = {-u.y, u.x};
    else
        across = cross(u, facet.points[2] - facet.points[0]);
    constexpr double rounding = 1e-14;
    double height = 0, reach = 0;
    for (int i = 0; i < D; ++i) {
        const double middle = 0.5 * (box.lower[i] + box.upper[i]), half = 0.5 * (box.upper[i] - box.lower[i]);
        const double size = std::fabs(across[i]), p = facet.points[0][i];
        height += across[i] * (middle - p);
        reach += size * (half + rounding * (half + std::fabs(middle) + std::fabs(p)));
    }
    return !(std::fabs(height) > reach);
}

template <class Ground>
constexpr bool is_terrain_type =
    std::is_same_v<Ground, Chain> || std::is_same_v<Ground, Mesh> || std::is_same_v<Ground, HeightField<2>> ||
    std::is_same_v<Ground, HeightField<3>>;

/// The ground that does not change: a chain, a mesh or a height field, in the frame of its body. It is a list
/// of facets: the segments of a chain and the triangles of a mesh have the numbers that they were given;
/// those of a height field are counted cell by cell, row by row, two for a cell in space. Some may be missing
/// (holes, triangles without area): nothing ever visits them.
template <int D>
class Terrain {
  public:
    /// Throws `Error` that names the field for what cannot be. What is large is made by the workers of the
    /// scheduler, if there is one; the result is the same.
    Terrain(const Chain& chain, const Transform<D>& placed, Scheduler* scheduler = nullptr) requires(D == 2);
    Terrain(const Mesh& mesh, const Transform<D>& placed, Scheduler* scheduler = nullptr) requires(D == 3);
    Terrain(const HeightField<D>& field, const Transform<D>& placed, Scheduler* scheduler = nullptr);

    /// Around all facets that exist.
    const Aabb<D>& bounds() const { return bounds_; }
    /// Number of facets, the missing ones included.
    std::uint32_t size() const { return is_grid_ ? grid_.size() : std::uint32_t(facets_.size()); }
    Facet<D> facet(std::uint32_t index) const;
    /// The facet's own material, or null where the shape's applies.
    const Material* material(std::uint32_t facet) const {
        if (material_of_.empty()) return nullptr;
        return &materials_[material_of_[is_grid_ ? facet / HeightGrid<D>::facets_per_cell : facet]];
    }

    /// Calls `visit(index)` for every facet that touches `box`, and for few that do not (see `may_touch`).
    /// The order depends on the terrain and the box alone.
    template <class Visitor>
    void query(const Aabb<D>& box, Visitor&& visit) const;

    /// Calls `visit(index, max_fraction)` for every facet that a point, or a box with the half lengths
    /// `half`, may meet on its way from `origin` to `origin` + max_fraction · `translation`, and for a few
    /// others, roughly front to back. What `visit` returns is the `max_fraction` from then on.
    template <class Visitor>
    void cast(const Vec<D>& origin, const Vec<D>& translation, double max_fraction, Visitor&& visit,
              const Vec<D>& half = {}) const;

    /// Memory that it holds.
    std::size_t bytes() const;

  private:
    void build(Scheduler* scheduler);
    bool exists(const Facet<D>& facet) const;

    Aabb<D> bounds_{};
    bool is_grid_ = false, two_sided_ = false;
    std::vector<Vec<D>> vertices_;
    std::vector<std::array<std::uint32_t, D>> facets_;
    FacetTree<D> tree_;
    HeightGrid<D> grid_;
    std::vector<Material> materials_;
    std::vector<std::uint16_t> material_of_;
};

template <int D>
Facet<D> Terrain<D>::facet(std::uint32_t index) const {
    if (is_grid_) return {grid_.facet(index), false};
    Facet<D> facet{{}, two_sided_};
    for (int i = 0; i < D; ++i) facet.points[i] = vertices_[facets_[index][i]];
    return facet;
}

template <int D>
template <class Visitor>
void Terrain<D>::query(const Aabb<D>& box, Visitor&& visit) const {
    const auto check = [&](std::uint32_t index) {
        if (may_touch(facet(index), box)) visit(index);
    };
    if (!is_grid_)
        tree_.query(box, check);
    else
        grid_.query(box, [&](std::uint32_t index) {
            if (exists(facet(index))) check(index);
        });
}

template <int D>
template <class Visitor>
void Terrain<D>::cast(const Vec<D>& origin, const Vec<D>& translation, double max_fraction, Visitor&& visit,
                      const Vec<D>& half) const {
    const Ray<D> ray{origin, translation, half};
    if (!is_grid_)
        tree_.cast(ray, max_fraction, visit);
    else
        grid_.cast(ray, max_fraction, [&](std::uint32_t index, double max) {
            return exists(facet(index)) ? visit(index, max) : max;
        });
}

}  // namespace carom::detail
