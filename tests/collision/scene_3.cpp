#include "scene_3.hpp"

namespace carom::test::space {

namespace {

Rotation3 random_turn(bool aligned, Random& random) {
    if (!aligned) return random.rotation<3>();
    constexpr double quarter = 0.5 * 3.14159265358979323846;
    Rotation3 turn;
    for (int i = 0; i < 3; ++i) {
        Vec3 axis;
        axis[i] = 1;
        turn = turn * Rotation3::from_axis_angle(axis, quarter * random.below(4));
    }
    const double tremble[] = {0, 1e-15, 1e-9, 1e-6, 1e-4, 1e-2};
    return Rotation3::from_axis_angle(random.direction<3>(), tremble[random.below(6)]) * normalized(turn);
}

}  // namespace

Scene::Scene(Kind kind_a, Kind kind_b, bool aligned, Random& random) {
    const double size_a = std::pow(10, random.between(-2, 2));
    const double size_b = size_a * std::pow(10, random.between(-0.5, 0.5));
    a = random_geometry(kind_a, size_a, random);
    b = random_geometry(kind_b, size_b, random);
    a_placed = {random.in_cube<3>(size_a), random_turn(aligned, random)};
    b_placed = {a_placed.position, random_turn(aligned, random)};
    b_placed.position += random.between(0, 0.6) * (size_a + size_b) * random.direction<3>();
}

void Scene::bring_to(Random& random) {
    const double size = smaller_size(oracle_a(), oracle_b());
    const double gaps[] = {0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 0.1};
    const auto found = separation<3>(a, a_placed, b, b_placed);
    const int choice = random.below(16);
    if (choice < 14) {
        const double gap = (choice < 7 ? 1 : -1) * size * gaps[choice % 7];
        b_placed.position += (gap - found->distance) * found->axis;
    }
}

double smaller_size(const Body3& a, const Body3& b) {
    if (a.is_plane()) return b.size();
    return b.is_plane() ? a.size() : std::min(a.size(), b.size());
}

std::string name_of_pair(const std::tuple<int, int>& pair) {
    return name_of(static_cast<Kind>(std::get<0>(pair))) + "_" +
           name_of(static_cast<Kind>(std::get<1>(pair)));
}

}  // namespace carom::test::space
