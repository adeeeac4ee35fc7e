#include "solver/lane_shapes.hpp"

#include <algorithm>

namespace carom::detail {

namespace {

/// Beyond this radius of a body, a `float` no longer tells places on it apart by a few micrometres.
constexpr double largest_radius = 50;  // m

struct Corner {
    Vec2 at, normal;  ///< normal: of the edge from here to the next
};

/// Counter-clockwise; a capsule has one edge there and one back.
std::vector<Corner> corners_of(const Shape<2>& shape) {
    std::vector<Corner> corners;
    if (shape.core) {
        for (std::size_t i = 0; i < shape.core->vertices.size(); ++i)
            corners.push_back({shape.core->vertices[i], shape.core->normals[i]});
    } else if (const double along = length(shape.b - shape.a); shape.kind == ShapeKind::ball || along == 0) {
        corners.push_back({shape.a, {}});
    } else {
        const Vec2 t = (shape.b - shape.a) / along, normal{t.y, -t.x};
        corners = {{shape.a, normal}, {shape.b, -normal}};
    }
    return corners;
}

bool is_for_lanes(const Shape<2>& shape, const BodyMass<2>& mass) {
    const bool is_kind = shape.kind == ShapeKind::ball || shape.kind == ShapeKind::capsule ||
                         ((shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull) &&
                          shape.core->vertices.size() <= LaneShapes<2>::most_corners);
    return is_kind && mass.radius > 0 && mass.radius <= largest_radius;
}

}  // namespace

std::uint32_t LaneShapes<2>::find(std::uint32_t shape, const Shape<2>& its, const BodyMass<2>& mass) {
    if (shape >= places_.size()) places_.resize(shape + 1, unknown);
    std::uint32_t& place = places_[shape];
    if (place != unknown) return place;
    if (!is_for_lanes(its, mass)) return place = none;
    if (free_.empty()) {
        place = static_cast<std::uint32_t>(floats_.size() / stride);
        floats_.resize(floats_.size() + stride);
    } else {
        place = free_.back();
        free_.pop_back();
    }
    const std::vector<Corner> corners = corners_of(its);
    float* to = floats_.data() + place * stride;
    const auto put = [&](double a, double b, double c, double d) {
        for (const double value : {a, b, c, d}) *to++ = static_cast<float>(value);
    };
    put(static_cast<double>(corners.size()), its.radius, mass.radius, static_cast<double>(its.kind));
    for (std::size_t i = 0; i < most_corners; ++i) {
        const Corner& c = corners[std::min(i, corners.size() - 1)];
        put(c.at.x - mass.center.x, c.at.y - mass.center.y, c.normal.x, c.normal.y);
    }
    return place;
}

void LaneShapes<2>::forget(std::uint32_t shape) {
    if (shape >= places_.size()) return;
    if (places_[shape] != unknown && places_[shape] != none) free_.push_back(places_[shape]);
    places_[shape] = unknown;
}

}  // namespace carom::detail
