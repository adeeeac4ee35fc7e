#include "carom/decompose.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "carom/error.hpp"
#include "carom/mass.hpp"
#include "geometry/shape.hpp"

namespace carom {

namespace {

double area(const std::vector<Vec2>& p) {
    double twice = 0;
    for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p[i], p[(i + 1) % p.size()]);
    return std::fabs(twice) / 2;
}

/// The area that two convex polygons share (Sutherland and Hodgman 1974).
double shared_area(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    std::vector<Vec2> rest = a;
    for (std::size_t i = 0; i < b.size(); ++i) {
        const Vec2 from = b[i], along = b[(i + 1) % b.size()] - from;
        std::vector<Vec2> kept;
        for (std::size_t k = 0; k < rest.size(); ++k) {
            const Vec2 p = rest[k], q = rest[(k + 1) % rest.size()];
            const double at_p = cross(along, p - from), at_q = cross(along, q - from);
            if (at_p >= 0) kept.push_back(p);
            if ((at_p >= 0) != (at_q >= 0)) kept.push_back(p + at_p / (at_p - at_q) * (q - p));
        }
        rest = kept;
    }
    return area(rest);
}

void expect_cut_up(const std::vector<Vec2>& outline, std::size_t most_pieces) {
    const std::vector<Hull2> pieces = convex_pieces(outline);
    EXPECT_LE(pieces.size(), most_pieces);
    const double whole = area(outline);
    double sum = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const double own = area(pieces[i].points);
        sum += own;
        EXPECT_NEAR(measure<2>(pieces[i]), own, 1e-5 * whole) << "a piece is its own convex hull";
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_LE(shared_area(pieces[i].points, pieces[j].points), 1e-9 * whole);
    }
    EXPECT_NEAR(sum, whole, 1e-3 * whole);
}

TEST(Decompose2, PiecesAreConvexDoNotOverlapAndMakeUpTheWhole) {
    expect_cut_up({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1);
    expect_cut_up({{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}}, 2);                          // L
    expect_cut_up({{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3);          // U
    expect_cut_up({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {1, 1}, {0, 1}}, 3);  // in line
    std::vector<Vec2> star, spiral;
    for (int i = 0; i < 10; ++i) {
        const Rotation2 turn = Rotation2::from_angle(i * 0.62831853);
        star.push_back(rotate(turn, Vec2{i % 2 == 0 ? 2.0 : 0.8, 0}));
    }
    expect_cut_up(star, 6);
    for (int i = 0; i <= 60; ++i) spiral.push_back(rotate(Rotation2::from_angle(0.2 * i), {1 + 0.1 * i, 0}));
    for (int i = 60; i >= 0; --i)
        spiral.push_back(rotate(Rotation2::from_angle(0.2 * i), {0.7 + 0.1 * i, 0}));
    expect_cut_up(spiral, 70);
}

TEST(Decompose2, RandomOutlinesAreCutUp) {
    std::mt19937_64 random(5);
    for (int n = 0; n < 60; ++n) {
        std::vector<Vec2> outline;
        const int corners = 4 + n;
        for (int i = 0; i < corners; ++i) {
            const double radius = 0.3 + double(random() >> 11) * 0x1p-53;
            const Vec2 p = rotate(Rotation2::from_angle(6.2831853 * i / corners), {radius, 0});
            outline.push_back(p + Vec2{10, -3});
        }
        if (n % 2 == 0) std::reverse(outline.begin(), outline.end());
        SCOPED_TRACE(n);
        expect_cut_up(outline, outline.size() - 2);
    }
}

std::string refusal(const std::vector<Vec2>& outline) {
    try {
        convex_pieces(outline);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Decompose2, RefusesWhatIsNoSimplePolygon) {
    EXPECT_EQ(refusal({{0, 0}, {1, 0}}), "points: 2 are fewer than 3");
    EXPECT_EQ(refusal({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),
              "outline: the edges from outline[0] and from outline[2] meet");
    EXPECT_EQ(refusal({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "outline[2]: lies at the same place as outline[1]");
    EXPECT_EQ(refusal({{0, 0}, {1, 1}, {2, 2}}), "outline: it has no area");
}

/// A prism over an outline that is cut into triangles as given, along z from 0 to `height`.
Mesh prism(const std::vector<Vec2>& outline, const std::vector<std::array<std::uint32_t, 3>>& caps,
           double height) {
    Mesh mesh;
    const auto count = std::uint32_t(outline.size());
    for (const double z : {0.0, height})
        for (const Vec2& p : outline) mesh.vertices.push_back({p.x, p.y, z});
    for (const auto& [a, b, c] : caps) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({a + count, b + count, c + count});
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        mesh.triangles.push_back({i, next, next + count});
        mesh.triangles.push_back({i, next + count, i + count});
    }
    return mesh;
}

double volume(const std::vector<Hull3>& pieces) {
    double sum = 0;
    for (const Hull3& piece : pieces) sum += measure<3>(piece);
    return sum;
}

/// Is the point within one of the pieces?
bool is_held(const std::vector<Hull3>& pieces, const Vec3& point) {
    for (const Hull3& piece : pieces) {
        const detail::Polyhedron hull = detail::convex_polyhedron(piece.points);
        bool inside = true;
        for (std::size_t f = 0; f < hull.normals.size(); ++f)
            inside &= dot(hull.normals[f], point) <= hull.offsets[f] + 1e-4;
        if (inside) return true;
    }
    return false;
}

const std::vector<Vec2> letter{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};  // an L, 3 large
const std::vector<std::array<std::uint32_t, 3>> letter_caps{{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}};

TEST(Decompose3, AnAngleIsTwoBoxes) {
    // One of the planes that are tried lies in the faces of the notch.
    const Mesh mesh = prism(letter, letter_caps, 1);
    const std::vector<Hull3> pieces = convex_pieces(mesh, {.planes = 1});
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_NEAR(volume(pieces), 3, 1e-9);
    for (const Vec3& p : mesh.vertices) EXPECT_TRUE(is_held(pieces, p));
    EXPECT_EQ(convex_pieces(mesh, {.most_pieces = 1}).size(), 1u);
    EXPECT_EQ(convex_pieces(mesh, {.concavity = 1}).size(), 1u);
}

TEST(Decompose3, APieceIsNoLargerThanWasAsked) {
    const Mesh mesh = prism(letter, letter_caps, 1);
    for (const double concavity : {0.05, 0.01}) {
        const std::vector<Hull3> pieces = convex_pieces(mesh, {.concavity = concavity, .planes = 6});
        EXPECT_GE(volume(pieces), 3 - 1e-9);
        EXPECT_LE(volume(pieces), 3 + double(pieces.size()) * concavity * 3.5);
        for (const Vec3& p : mesh.vertices) EXPECT_TRUE(is_held(pieces, p));
    }
}

TEST(Decompose3, ARingKeepsItsHole) {
    // A torus: 24 around, 12 round the tube.
    Mesh mesh;
    constexpr std::uint32_t around = 24, tube = 12;
    for (std::uint32_t i = 0; i < around; ++i) {
        const Rotation2 big = Rotation2::from_angle(6.283185307179586 * i / around);
        for (std::uint32_t k = 0; k < tube; ++k) {
            const Rotation2 small = Rotation2::from_angle(6.283185307179586 * k / tube);
            const double radius = 2 + 0.5 * small.c;
            mesh.vertices.push_back({radius * big.c, radius * big.s, 0.5 * small.s});
            const std::uint32_t a = i * tube + k, b = i * tube + (k + 1) % tube;
            const std::uint32_t c = (i + 1) % around * tube + k, d = (i + 1) % around * tube + (k + 1) % tube;
            mesh.triangles.push_back({a, c, d});
            mesh.triangles.push_back({a, d, b});
        }
    }
    const std::vector<Hull3> pieces = convex_pieces(mesh);
    EXPECT_GT(pieces.size(), 4u);
    EXPECT_LE(pieces.size(), 32u);
    const double exact = 2 * 9.8696 * 2 * 0.25;
    EXPECT_NEAR(volume(pieces), exact, 0.15 * exact);
    EXPECT_FALSE(is_held(pieces, {0, 0, 0}));
    for (const Vec3& p : mesh.vertices) EXPECT_TRUE(is_held(pieces, p));
}

std::string refusal(const Mesh& mesh, const Decomposition& settings = {}) {
    try {
        convex_pieces(mesh, settings);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Decompose3, RefusesWhatHoldsNoVolumeAndSettingsOutOfRange) {
    Mesh mesh = prism(letter, letter_caps, 1);
    EXPECT_EQ(refusal(mesh, {.concavity = 2}), "concavity: 2 is not between 0 and 1");
    EXPECT_EQ(refusal(mesh, {.most_pieces = 0}), "most_pieces: 0 is not between 1 and 1024");
    EXPECT_EQ(refusal(mesh, {.planes = 1000}), "planes: 1000 is not between 1 and 256");
    Mesh inside_out = mesh;
    for (auto& corners : inside_out.triangles) std::swap(corners[0], corners[1]);
    EXPECT_EQ(refusal(inside_out),
              "triangles: they hold no volume; corners must run counter-clockwise seen from outside");
    mesh.triangles.pop_back();
    EXPECT_NE(refusal(mesh).find("triangles: the surface is not closed at the edge between"),
              std::string::npos);
}

}  // namespace

}  // namespace carom
