#include "oracle_3.hpp"

namespace carom::test::space {

namespace {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& q, const Vec3& x) {
    const double whole = length_squared(q - p);
    return whole > 0 ? p + std::clamp(dot(x - p, q - p) / whole, 0.0, 1.0) * (q - p) : p;
}

}  // namespace

Body3::Body3(const Geometry<3>& geometry, const Transform3& placed) : placed_(placed) {
    std::visit([this](const auto& shape) { set(shape); }, geometry);
    for (const Vec3& vertex : vertices_) corners_.push_back(apply(placed_, vertex));
    for (const Face& face : faces_) placed_normals_.push_back(rotate(placed_.rotation, face.normal));
}

Body3::Body3(const std::array<Vec3, 3>& triangle)
    : vertices_(triangle.begin(), triangle.end()), corners_(vertices_) {
    const Vec3 normal = normalized(cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
    placed_normals_ = {normal, -normal};
    for (const Vec3& n : placed_normals_) faces_.push_back({n, dot(n, triangle[0])});
    for (std::size_t i = 0; i < 3; ++i) size_ = std::max(size_, length(triangle[i] - triangle[(i + 1) % 3]));
}

void Body3::set(const Ball& ball) {
    vertices_ = {{0, 0, 0}};
    radius_ = ball.radius;
    size_ = thickness_ = 2 * ball.radius;
}

void Body3::set(const Box3& box) {
    radius_ = box.rounding;
    const Vec3 half = 0.5 * box.size - Vec3{radius_, radius_, radius_};
    for (int i = 0; i < 8; ++i)
        vertices_.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
            Vec3 normal;
            normal[axis] = sign;
            faces_.push_back({normal, half[axis]});
        }
    }
    size_ = std::max({box.size.x, box.size.y, box.size.z});
    thickness_ = std::min({box.size.x, box.size.y, box.size.z});
}

void Body3::set(const Capsule3& capsule) {
    vertices_ = {capsule.from, capsule.to};
    radius_ = capsule.radius;
    size_ = length(capsule.to - capsule.from) + 2 * radius_;
    thickness_ = 2 * radius_;
}

void Body3::set(const Hull3& hull) {
    hull_ = true;
    vertices_ = hull.points;
    radius_ = hull.rounding;
    find_faces();
    double inner = 1e300;
    for (const Face& face : faces_) {
        double lowest = 1e300;
        for (const Vec3& p : vertices_) lowest = std::min(lowest, dot(face.normal, p));
        inner = std::min(inner, face.offset - lowest);
    }
    for (const Vec3& p : vertices_) {
        for (const Vec3& q : vertices_) size_ = std::max(size_, length(p - q) + 2 * radius_);
    }
    thickness_ = inner + 2 * radius_;
}

void Body3::set(const Plane3& plane) {
    plane_ = true;
    half_space_ = {normalized(plane.normal), plane.offset};
    faces_ = {{half_space_.normal, half_space_.offset}};
    size_ = 0;
    thickness_ = 1e300;
}

void Body3::set_revolved(double bottom, double top, double height) {
    bottom_ = bottom;
    top_ = top;
    half_height_ = 0.5 * height;
    size_ = std::max(2 * bottom, height);
    thickness_ = std::min(2 * bottom, height);
}

void Body3::find_faces() {
    const std::size_t n = vertices_.size();
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            for (std::size_t k = i + 1; k < n; ++k) {
                if (j == i || j == k) continue;
                const Vec3 across = cross(vertices_[j] - vertices_[i], vertices_[k] - vertices_[i]);
                const double area = length(across);
                if (area < 1e-12 * length_squared(vertices_[j] - vertices_[i])) continue;
                const Vec3 normal = across / area;
                const double offset = dot(normal, vertices_[i]);
                const bool outer = std::all_of(vertices_.begin(), vertices_.end(), [&](const Vec3& p) {
                    return dot(normal, p) <= offset + 1e-10 * length(vertices_[j] - vertices_[i]);
                });
                if (outer) faces_.push_back({normal, offset});
            }
        }
    }
}

double Body3::reach(const Vec3& direction) const {
    const Vec3 d = unrotate(placed_.rotation, direction);
    double furthest = -1e300;
    if (plane_)
        return length(d - half_space_.normal) < 1e-7 ? half_space_.offset + dot(direction, placed_.position)
                                                     : 1e300;
    for (const Vec3& vertex : vertices_) furthest = std::max(furthest, dot(d, vertex));
    if (vertices_.empty()) {
        const double across = std::sqrt(d.x * d.x + d.z * d.z);
        furthest = std::max(d.y * half_height_ + top_ * across, -d.y * half_height_ + bottom_ * across);
    }
    return furthest + radius_ + dot(direction, placed_.position);
}

double Body3::height(const Vec3& point) const {
    const Vec3 p = apply_inverse(placed_, point);
    if (plane_) return dot(half_space_.normal, p) - half_space_.offset;
    if (vertices_.empty()) return revolved_height(p);
    if (vertices_.size() == 1) return length(p - vertices_[0]) - radius_;
    if (vertices_.size() == 2) return length(p - nearest_on_segment(vertices_[0], vertices_[1], p)) - radius_;
    return polyhedron_height(p) - radius_;
}

double Body3::polyhedron_height(const Vec3& p) const {
    double highest = -1e300;
    for (const Face& face : faces_) highest = std::max(highest, dot(face.normal, p) - face.offset);
    if (highest <= 0) return highest;
    // Over a face, or nearest to a line between two corners (an edge, or an inner line that is no nearer).
    double least = 1e300;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, length(p - nearest_on_segment(vertices_[i], vertices_[j], p)));
    }
    for (const Face& face : faces_) {
        const double over = dot(face.normal, p) - face.offset;
        const Vec3 foot = p - over * face.normal;
        const bool within = std::all_of(faces_.begin(), faces_.end(), [&](const Face& other) {
            return dot(other.normal, foot) <= other.offset + 1e-10 * size_;
        });
        if (over > 0 && within) least = std::min(least, over);
    }
    return least;
}

double Body3::revolved_height(const Vec3& p) const {
    const double r = std::sqrt(p.x * p.x + p.z * p.z), h = half_height_;
    const Vec3 flat{r, p.y, 0};
    const Vec3 profile[4] = {{0, -h, 0}, {bottom_, -h, 0}, {top_, h, 0}, {0, h, 0}};
    double least = 1e300;
    for (int i = 0; i < 3; ++i)
        least = std::min(least, length(flat - nearest_on_segment(profile[i], profile[i + 1], flat)));
    const double width = bottom_ + (top_ - bottom_) * (p.y + h) / (2 * h);
    return r < width && std::fabs(p.y) < h ? -least : least;
}

double gap_along(const Body3& a, const Body3& b, const Vec3& axis) { return -b.reach(-axis) - a.reach(axis); }

namespace {

/// Calls `offer` with each direction in which two features of the cores could be nearest.
template <class Offer>
void for_features(const Body3& a, const Body3& b, const Offer& offer) {
    for (const Vec3& normal : a.normals()) offer(normal);
    for (const Vec3& normal : b.normals()) offer(-normal);
    const std::vector<Vec3>&p = a.corners(), &q = b.corners();
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t k = 0; k < q.size(); ++k) {
            offer(q[k] - p[i]);
            for (std::size_t j = 0; j < i; ++j) offer(q[k] - nearest_on_segment(p[i], p[j], q[k]));
            for (std::size_t l = 0; l < k; ++l) offer(nearest_on_segment(q[k], q[l], p[i]) - p[i]);
            for (std::size_t j = 0; j < i; ++j) {
                for (std::size_t l = 0; l < k; ++l) {
                    const Vec3 across = cross(p[i] - p[j], q[k] - q[l]);
                    offer(across);
                    offer(-across);
                }
            }
        }
    }
}

/// Improves a direction by random steps that shrink when they no longer help.
double climb(const Body3& a, const Body3& b, Vec3 axis, double gap, Random& random) {
    double stride = 0.1;
    for (int i = 0; i < 400 && stride > 1e-10; ++i) {
        const Vec3 next = normalized(axis + stride * random.direction<3>());
        const double candidate = gap_along(a, b, next);
        if (candidate > gap) {
            axis = next;
            gap = candidate;
            stride *= 1.5;
        } else {
            stride *= 0.85;
        }
    }
    return gap;
}

}  // namespace

double widest_gap(const Body3& a, const Body3& b) {
    double widest = -1e300;
    for_features(a, b, [&](const Vec3& direction) {
        const double size = length(direction);
        if (size > 1e-9 * (a.size() + b.size()) * std::min(1.0, a.size() + b.size()))
            widest = std::max(widest, gap_along(a, b, direction / size));
    });
    if (a.is_plane() || b.is_plane() || (!a.corners().empty() && !b.corners().empty())) return widest;

    Random random(1);
    struct Start {
        Vec3 axis;
        double gap;
    };
    std::vector<Start> starts;
    const auto start = [&](const Vec3& axis) { starts.push_back({axis, gap_along(a, b, axis)}); };
    for (int i = 0; i < 600; ++i) start(random.direction<3>());
    const Vec3 apart = b.placed().position - a.placed().position;
    if (length(apart) > 0) start(normalized(apart));
    std::sort(starts.begin(), starts.end(), [](const Start& p, const Start& q) { return p.gap > q.gap; });
    for (std::size_t i = 0; i < 12; ++i)
        widest = std::max(widest, climb(a, b, starts[i].axis, starts[i].gap, random));
    return widest;
}

std::string name_of(Kind kind) {
    const char* names[] = {"ball", "box", "capsule", "hull", "plane", "cylinder", "cone"};
    return names[static_cast<int>(kind)];
}

Geometry<3> random_geometry(Kind kind, double size, Random& random) {
    const auto part = [&] {
        return size * (random.below(6) == 0 ? random.between(0.01, 0.05) : random.between(0.2, 1));
    };
    switch (kind) {
        case Kind::ball:
            return Ball{0.5 * part()};
        case Kind::box: {
            const Vec3 lengths{part(), part(), part()};
            const double thinnest = std::min({lengths.x, lengths.y, lengths.z});
            return Box3{lengths, random.below(2) ? 0.0 : random.between(0, 0.45) * thinnest};
        }
        case Kind::capsule: {
            const Vec3 half = 0.4 * part() * random.direction<3>(), center = random.in_cube<3>(0.2 * size);
            return Capsule3{center - half, center + half, 0.3 * part()};
        }
        case Kind::hull: {
            Hull3 hull;
            const Vec3 lengths{part(), part(), part()};
            const int count = 5 + random.below(8);
            for (int i = 0; i < count; ++i) {
                const Vec3 p = random.direction<3>();
                hull.points.push_back({0.5 * lengths.x * p.x, 0.5 * lengths.y * p.y, 0.5 * lengths.z * p.z});
            }
            hull.rounding = random.below(2) ? 0.0 : 0.05 * size * random.unit();
            return hull;
        }
        case Kind::plane:
            return Plane3{random.direction<3>(), random.between(-size, size)};
        case Kind::cylinder:
            return Cylinder{0.5 * part(), part()};
        case Kind::cone:
            return Cone{0.5 * part(), part()};
    }
    return Ball{size};
}

}  // namespace carom::test::space
