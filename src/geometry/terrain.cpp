#include "geometry/terrain.hpp"

#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "core/crew.hpp"
#include "geometry/shape.hpp"
#include "math/check.hpp"

namespace carom::detail {

namespace {

std::string item(std::string_view list, std::size_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
}

void check_count(std::string_view list, std::size_t count, std::size_t least, std::size_t most) {
    if (count < least)
        throw Error(std::string(list) + ": " + std::to_string(count) + " are fewer than " +
                    std::to_string(least));
    if (count > most)
        throw Error(std::string(list) + ": " + std::to_string(count) + " are more than " +
                    std::to_string(most));
}

template <int D>
void check_places(std::string_view list, const std::vector<Vec<D>>& points) {
    const double most = longest_length;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec<D>& p = points[i];
        bool fine = true;
        for (int k = 0; k < D; ++k) fine &= std::fabs(p[k]) <= most;
        if (!fine) require_in(p, -most, most, item(list, i));
    }
}

/// Checks the list of materials and the choice among them for each of `count` facets or cells.
void check_materials(const std::vector<Material>& materials, const std::vector<std::uint16_t>& material_of,
                     std::size_t count, std::string_view what) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        try {
            check_material(materials[i]);
        } catch (const Error& error) {
            throw Error(item("materials", i) + "." + error.what());
        }
    }
    if (materials.empty() && material_of.empty()) return;
    if (material_of.size() != count)
        throw Error("material_of: has " + std::to_string(material_of.size()) + " entries for " +
                    std::to_string(count) + " " + std::string(what));
    for (std::size_t i = 0; i < count; ++i) {
        if (material_of[i] >= materials.size())
            throw Error(item("material_of", i) + ": " + std::to_string(material_of[i]) +
                        " is not the index of one of the " + std::to_string(materials.size()) + " materials");
    }
}

template <int D>
Aabb<D> merged(Aabb<D> a, const Aabb<D>& b) {
    for (int i = 0; i < D; ++i) {
        a.lower[i] = std::min(a.lower[i], b.lower[i]);
        a.upper[i] = std::max(a.upper[i], b.upper[i]);
    }
    return a;
}

/// Facets thinner than this share of their length have no normal that one could rely on.
constexpr double thinnest = 1e-10;

template <int D>
bool has_area(const Facet<D>& facet) {
    if constexpr (D == 2) {
        return facet.points[0] != facet.points[1];
    } else {
        const Vec3 u = facet.points[1] - facet.points[0], v = facet.points[2] - facet.points[0];
        const double longest = std::max({length_squared(u), length_squared(v), length_squared(v - u)});
        return length(cross(u, v)) > thinnest * longest;
    }
}

}  // namespace

template <int D>
Terrain<D>::Terrain(const Chain& chain, const Transform<D>& placed, Scheduler* scheduler) requires(D == 2)
    : two_sided_(chain.two_sided), materials_(chain.materials), material_of_(chain.material_of) {
    const std::size_t count = chain.points.size();
    check_count("points", count, chain.loop ? 3 : 2, FacetTree<2>::most_items);
    check_places<2>("points", chain.points);
    const std::size_t segments = chain.loop ? count : count - 1;
    for (std::size_t i = 0; i < segments; ++i) {
        const std::size_t next = (i + 1) % count;
        if (length(chain.points[next] - chain.points[i]) < shortest_length)
            throw Error(item("points", next) + ": lies at the same place as " + item("points", i));
        facets_.push_back({std::uint32_t(i), std::uint32_t(next)});
    }
    check_materials(materials_, material_of_, segments, "segments");
    for (const Vec2& p : chain.points) vertices_.push_back(apply(placed, p));
    build(scheduler);
}

template <int D>
Terrain<D>::Terrain(const Mesh& mesh, const Transform<D>& placed, Scheduler* scheduler) requires(D == 3)
    : two_sided_(mesh.two_sided),
      facets_(mesh.triangles),
      materials_(mesh.materials),
      material_of_(mesh.material_of) {
    check_count("vertices", mesh.vertices.size(), 3, std::numeric_limits<std::uint32_t>::max());
    check_count("triangles", mesh.triangles.size(), 1, FacetTree<3>::most_items);
    check_places<3>("vertices", mesh.vertices);
    for (std::size_t i = 0; i < facets_.size(); ++i) {
        const auto& corners = facets_[i];
        for (std::size_t k = 0; k < 3; ++k) {
            if (corners[k] >= mesh.vertices.size())
                throw Error(item("triangles", i) + ": " + std::to_string(corners[k]) +
                            " is not the index of one of the " + std::to_string(mesh.vertices.size()) +
                            " vertices");
            if (corners[k] == corners[(k + 1) % 3])
                throw Error(item("triangles", i) + ": names vertex " + std::to_string(corners[k]) + " twice");
        }
    }
    check_materials(materials_, material_of_, facets_.size(), "triangles");
    vertices_.reserve(mesh.vertices.size());
    for (const Vec3& p : mesh.vertices) vertices_.push_back(apply(placed, p));
    build(scheduler);
}

namespace {

/// All heights in one row, and how many there are in each direction.
std::pair<std::vector<double>, std::array<std::uint32_t, 1>> flattened(const HeightField<2>& field) {
    return {field.heights, {std::uint32_t(field.heights.size())}};
}

std::pair<std::vector<double>, std::array<std::uint32_t, 2>> flattened(const HeightField<3>& field) {
    const std::size_t columns = field.heights[0].size();
    std::vector<double> all;
    all.reserve(columns * field.heights.size());
    for (std::size_t row = 0; row < field.heights.size(); ++row) {
        if (field.heights[row].size() != columns)
            throw Error(item("heights", row) + ": has " + std::to_string(field.heights[row].size()) +
                        " heights, the first row has " + std::to_string(columns));
        all.insert(all.end(), field.heights[row].begin(), field.heights[row].end());
    }
    return {std::move(all), {std::uint32_t(columns), std::uint32_t(field.heights.size())}};
}

template <int D>
void check_field(const HeightField<D>& field) {
    constexpr std::size_t most = 1u << 15;  // so that twice the cells can be counted
    check_count("heights", field.heights.size(), 2, D == 2 ? FacetTree<D>::most_items : most);
    if constexpr (D == 3) check_count("heights[0]", field.heights[0].size(), 2, most);
    for (int i = 0; i < D - 1; ++i) {
        const std::string name = D == 2 ? "spacing" : component("spacing", i);
        require_positive(field.spacing[i], name);
        require_in(field.spacing[i], shortest_length, longest_length, name);
    }
    const auto check_row = [](const std::vector<double>& row, const std::string& name) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (row[i] == row[i]) require_in(row[i], -longest_length, longest_length, item(name, i));
        }
    };
    if constexpr (D == 2) {
        check_row(field.heights, "heights");
    } else {
        for (std::size_t row = 0; row < field.heights.size(); ++row)
            check_row(field.heights[row], item("heights", row));
    }
}

}  // namespace

template <int D>
Terrain<D>::Terrain(const HeightField<D>& field, const Transform<D>& placed, Scheduler* scheduler)
    : is_grid_(true), materials_(field.materials), material_of_(field.material_of) {
    check_field(field);
    auto [heights, count] = flattened(field);
    grid_ = HeightGrid<D>(std::move(heights), count, field.spacing, placed);
    check_materials(materials_, material_of_, grid_.size() / HeightGrid<D>::facets_per_cell, "cells");
    build(scheduler);
}

template <int D>
bool Terrain<D>::exists(const Facet<D>& facet) const {
    // A sum is not a number where one of its parts is not.
    Vec<D> sum{};
    for (const Vec<D>& p : facet.points) sum += p;
    return dot(sum, sum) < 1e300;
}

/// Finds the bounds and, for chains and meshes, grows the tree over the facets that have an area.
template <int D>
void Terrain<D>::build(Scheduler* scheduler) {
    constexpr std::size_t grain = 1u << 14;
    using Item = typename FacetTree<D>::Item;
    constexpr std::uint32_t missing = ~std::uint32_t{0};
    std::vector<Item> items(is_grid_ ? 0 : size());
    std::mutex joining;
    bool any = false;
    run_range(scheduler, size(), grain, [&](std::size_t begin, std::size_t end) {
        Aabb<D> around{};
        bool some = false;
        for (std::size_t k = begin; k < end; ++k) {
            const auto index = static_cast<std::uint32_t>(k);
            const Facet<D> here = facet(index);
            const bool counts = is_grid_ ? exists(here) : has_area(here);
            const Aabb<D> box = here.bounds();
            if (!is_grid_) items[k] = {box, counts ? index : missing};
            if (!counts) continue;
            around = some ? merged(around, box) : box;
            some = true;
        }
        const std::lock_guard lock(joining);
        if (some) bounds_ = any ? merged(bounds_, around) : around;
        any |= some;
    });
    if (!any) throw Error(is_grid_ ? "heights: all cells are holes" : "triangles: none has an area");
    std::erase_if(items, [](const Item& item) { return item.facet == missing; });
    tree_.build(items, scheduler);
}

template <int D>
std::size_t Terrain<D>::bytes() const {
    return vertices_.size() * sizeof(Vec<D>) + facets_.size() * sizeof(facets_[0]) + tree_.bytes() +
           grid_.bytes() + material_of_.size() * sizeof(material_of_[0]);
}

template class Terrain<2>;
template class Terrain<3>;

}  // namespace carom::detail
