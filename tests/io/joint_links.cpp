#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/record_links.hpp"

// What a replay draws of joints.

namespace carom::io {
namespace {

template <int D>
std::vector<ReplayLink> links_of(const std::string& joints) {
    const std::string where = D == 2 ? "[1, 1]" : "[1, 1, 0]", size = D == 2 ? "[1, 1]" : "[1, 1, 1]";
    const std::string text =
        R"({"carom": 1, "dimension": )" + std::to_string(D) + R"(, "bodies": [{"name": "box", "position": )" +
        where + R"(, "shapes": [{"type": "box", "size": )" + size + R"(}]}], "joints": [)" + joints + "]}";
    return joint_links(build<D>(parse_scene(text, "test")));
}

long count(const std::vector<ReplayLink>& links, const std::string& type) {
    return std::ranges::count(links, type, &ReplayLink::type);
}

TEST(JointLinks, ABodyHangsOnAnArmThatReachesTheAnchor) {
    const auto inside = links_of<2>(R"({"type": "hinge", "b": "box", "anchor": [1, 1.4]})");
    EXPECT_EQ(count(inside, "anchor"), 1);
    EXPECT_EQ(count(inside, "arm"), 0);
    const auto outside = links_of<2>(R"({"type": "hinge", "b": "box", "anchor": [1, 4]})");
    ASSERT_EQ(count(outside, "arm"), 1);
    const ReplayLink& arm = *std::ranges::find(outside, "arm", &ReplayLink::type);
    EXPECT_EQ(arm.a, -1);
    EXPECT_EQ(arm.b, 0);
    EXPECT_NEAR(arm.anchor_a[1], 4, 1e-12);
    EXPECT_NEAR(std::hypot(arm.anchor_b[0], arm.anchor_b[1]), 0, 1e-12);
}

TEST(JointLinks, RopesSpringsRailsAxesAndPathsAreDrawn) {
    EXPECT_EQ(count(links_of<2>(R"({"type": "distance", "b": "box", "anchor_a": [0, 5]})"), "rod"), 1);
    EXPECT_EQ(
        count(links_of<2>(
                  R"({"type": "distance", "b": "box", "anchor_a": [0, 5], "spring": {"frequency": 1}})"),
              "spring"),
        1);
    EXPECT_EQ(
        count(links_of<2>(
                  R"({"type": "slider", "b": "box", "anchor": [1, 1], "axis": [1, 0], "limits": [-2, 2]})"),
              "rail"),
        1);
    EXPECT_EQ(count(links_of<3>(R"({"type": "hinge", "b": "box", "anchor": [1, 1, 0], "axis": [0, 0, 1]})"),
                    "axis"),
              1);
    const auto path =
        links_of<2>(R"({"type": "path", "b": "box", "points": [[0, 0], [1, 1], [3, 1]], "smooth": false})");
    ASSERT_EQ(count(path, "path"), 2);
    EXPECT_NEAR(path[0].anchor_b[0], 1, 1e-12);
    EXPECT_EQ(
        count(links_of<2>(R"({"type": "hinge", "b": "box", "anchor": [1, 4], "break_force": 10})"), "arm"), 0)
        << "what may break is not there from first to last";
}

}  // namespace
}  // namespace carom::io
