#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom::io {

// A recorded simulation as plain data, the same for both dimensions: in 2D the third coordinate of a
// vector is not used, angular quantities are the third component (turning about z), and a rotation is the
// quaternion of a turn about z. docs/replay-format.md says how it is written down.

using ReplayVector = std::array<double, 3>;
using ReplayRotation = std::array<double, 4>;  ///< unit quaternion x, y, z, w

/// The quaternion of a turn by `angle` (rad) about z, for 2D.
ReplayRotation replay_rotation(double angle);

// The shapes and their fields are those of the scene file; a box's size includes its rounding, a hull's
// points do not.
struct ReplayBall {
    double radius = 0;
};

struct ReplayBox {
    ReplayVector size{};
    double rounding = 0;
};

struct ReplayCapsule {
    ReplayVector from{};
    ReplayVector to{};
    double radius = 0;
};

struct ReplayHull {
    std::vector<ReplayVector> points;               ///< 2D: the corners, counter-clockwise
    std::vector<std::vector<std::uint32_t>> faces;  ///< 3D: corners counter-clockwise seen from outside
    double rounding = 0;
};

struct ReplayCylinder {
    double radius = 0;
    double height = 0;
};

struct ReplayCone {
    double radius = 0;
    double height = 0;
};

struct ReplayPlane {
    ReplayVector normal{};
    double offset = 0;
};

/// Chains and meshes, and height fields as either.
struct ReplayGround {
    std::vector<ReplayVector> points;
    std::vector<std::vector<std::uint32_t>> facets;  ///< segments or triangles, by their corners
    bool two_sided = false;                          ///< else solid to the right of a segment's direction, or
                                                     ///< where a triangle's corners run clockwise
};

using ReplayGeometry = std::variant<ReplayBall, ReplayBox, ReplayCapsule, ReplayHull, ReplayCylinder,
                                    ReplayCone, ReplayPlane, ReplayGround>;

/// A shape, placed in the frame of its body.
struct ReplayShape {
    ReplayGeometry geometry;
    ReplayVector center{};
    ReplayRotation rotation{0, 0, 0, 1};
    std::string material;  ///< its name, from which the viewer takes the colour; may be empty
    bool sensor = false;
    std::optional<ReplayVector> one_way{};  ///< the open side, in the shape's frame
    ReplayVector surface_velocity{};        ///< in the shape's frame, m/s
};

enum class ReplayBodyType : std::uint8_t { fixed, kinematic, dynamic };

struct ReplayBody {
    std::string name;
    ReplayBodyType type = ReplayBodyType::dynamic;
    double mass = 0;                  ///< kg
    std::array<double, 6> inertia{};  ///< xx, yy, zz, xy, xz, yz in the body's frame, about the centre of
                                      ///< mass, kg·m²; 2D: zz alone
    ReplayVector center_of_mass{};    ///< in the body's frame, m
    std::vector<ReplayShape> shapes;
};

/// Something drawn between two bodies, for example a spring.
struct ReplayLink {
    std::string type = "spring";
    std::int32_t a = -1;  ///< index of a body, −1 for the world
    std::int32_t b = -1;
    ReplayVector anchor_a{};  ///< in the frame of the body, or of the world, m
    ReplayVector anchor_b{};
};

/// One body in one frame. Numbers that are not finite are shown as the body's last finite ones.
struct ReplayState {
    ReplayVector position{};  ///< of the centre of mass, m
    std::array<float, 4> rotation{0, 0, 0, 1};
    std::array<float, 3> velocity{};          ///< of the centre of mass, m/s
    std::array<float, 3> angular_velocity{};  ///< rad/s
    bool present = false;                     ///< false before the body is added and after it is removed
    bool awake = true;
    bool jumped = false;   ///< it was put here: the way from the last frame is not to be interpolated
    bool sensing = false;  ///< something is inside a sensor that it carries
};

struct ReplayContact {
    std::int32_t a = 0;  ///< index of a body
    std::int32_t b = 0;
    ReplayVector position{};        ///< m
    std::array<float, 3> normal{};  ///< unit length, from a to b
    float impulse = 0;              ///< along the normal, over the step, N·s
};

struct ReplayFrame {
    double kinetic = 0;  ///< energies of the whole world, J
    double potential = 0;
    std::vector<ReplayState> states;  ///< by index of body; those beyond its end are absent
    std::vector<ReplayContact> contacts;
};

struct Replay {
    int dimension = 3;  ///< 2 or 3
    std::string name;
    double step = 1.0 / 60;  ///< time between two frames, s
    ReplayVector gravity{};
    std::vector<ReplayBody> bodies;
    std::vector<ReplayLink> links;
    std::vector<ReplayFrame> frames;  ///< frame 0 is the start
    /// The contacts of every frame are kept while they fit this many bytes; else those of every 2nd, 4th, …
    std::size_t contact_bytes = 3'000'000;
};

/// The page that plays the replay: `page` (see `replay_template`) with the recording filled in.
/// Throws `Error` when the replay contradicts itself (dimension, step, indices of bodies).
std::string replay_html(const Replay& replay, std::string_view page);

/// Writes `replay_html(replay, replay_template())` to a file, whole or not at all. Throws `Error` that
/// names the file and the reason when it cannot be written.
void write_replay(const Replay& replay, const std::filesystem::path& path);

}  // namespace carom::io
