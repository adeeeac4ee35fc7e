#include <fmt/format.h>

#include <array>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Chains with a heavy end, and one that hangs between two points.

namespace carom::app {
namespace {

enum class Link { hinge, ball, rod };

constexpr int links = 20;
constexpr double link_length = 0.2;  // m

template <int D>
BodyDefinition<D> body_at(const Vec<D>& position, const Geometry<D>& shape, double mass) {
    BodyDefinition<D> body;
    body.position = position;
    body.mass = mass;
    body.shapes.push_back({shape});
    body.shapes.back().filter.mask = 0;
    return body;
}

/// A chain of links of 1 kg that hangs from the origin, `angle` off the vertical, with a heavy ball at its
/// end. Rods join balls; the others join capsules end to end.
template <int D>
struct HeavyEnd {
    World<D> world;
    std::vector<JointId<D>> joints;
    BodyId<D> last{};

    HeavyEnd(Link kind, double mass, double angle) : world(definition()) {
        const Vec<D> way = in_plane<D>(std::sin(angle), -std::cos(angle));
        std::optional<BodyId<D>> before;
        for (int i = 0; i < links; ++i) {
            const Vec<D> top = (i * link_length) * way, bottom = ((i + 1) * link_length) * way;
            const Vec<D> half = (0.45 * link_length) * way;
            const BodyId<D> link = world.add_body(
                kind == Link::rod ? body_at<D>(bottom, Ball{0.02}, i + 1 == links ? mass : 1)
                                  : body_at<D>(0.5 * (top + bottom), Capsule<D>{-half, half, 0.02}, 1));
            add_joint(kind, before, link, top, bottom);
            before = last = link;
        }
        if (kind == Link::rod) return;
        const Vec<D> end = (links * link_length) * way;
        last = world.add_body(body_at<D>(end, Ball{0.3}, mass));
        add_joint(kind, before, last, end, end);
    }

    /// What the top joint carries when all is still.
    double weight(Link kind, double mass) const { return (mass + links - (kind == Link::rod ? 1 : 0)) * g; }
    /// By how much the chain is longer than it should be, at most.
    double stretch() const {
        double sum = 0;
        for (const JointId<D>& joint : joints) sum += world.linear_error(joint);
        return sum;
    }

  private:
    static WorldDefinition<D> definition() {
        WorldDefinition<D> definition;
        definition.sleep = false;
        return definition;
    }

    void add_joint(Link kind, std::optional<BodyId<D>> a, BodyId<D> b, const Vec<D>& top,
                   const Vec<D>& bottom) {
        JointDefinition<D> joint;
        joint.a = a;
        joint.b = b;
        if (kind == Link::hinge) joint.kind = HingeJoint<D>{.anchor = top};
        if (kind == Link::ball) {
            BallJoint<D> ball;
            ball.anchor = top;
            joint.kind = ball;
        }
        if (kind == Link::rod) joint.kind = DistanceJoint<D>{.anchor_a = top, .anchor_b = bottom};
        joints.push_back(world.add_joint(joint));
    }
};

template <int D>
void add_hanging(std::vector<Result>& results, const std::string& what, Link kind, double ratio) {
    HeavyEnd<D> chain(kind, ratio, 0);
    double worst = 0;
    while (chain.world.time() < 5) {
        chain.world.step(frame);
        worst = std::max(worst, chain.stretch());
    }
    results.push_back(relative(what + ", hanging: tension at the top (N)", chain.weight(kind, ratio),
                               length(chain.world.joint_force(chain.joints[0])), {1e-2, 1e-4}));
    results.push_back(absolute(what + ", hanging: stretch (m)", 0, worst, {1e-3, 1e-4}));
}

/// Let go 30° off the vertical.
template <int D>
void add_swinging(std::vector<Result>& results, const std::string& what, Link kind, double ratio) {
    HeavyEnd<D> chain(kind, ratio, 30 * degree);
    const double start = chain.world.energy().total();
    double stretch = 0, energy = 0;
    while (chain.world.time() < 10) {
        chain.world.step(frame);
        stretch = std::max(stretch, chain.stretch());
        energy = std::max(energy, std::fabs(chain.world.energy().total() - start));
    }
    results.push_back(absolute(what + ", swinging: stretch (m)", 0, stretch, {1e-3, 1e-4}));
    const double whole = chain.weight(kind, ratio) * links * link_length;
    results.push_back(
        absolute(what + ", swinging: change of energy / m g L", 0, energy / whole, {1e-2, 1e-4}));
}

template <int D>
void add_heavy_ends(std::vector<Result>& results) {
    constexpr std::pair<Link, const char*> kinds[] = {
        {Link::hinge, "hinges"}, {Link::ball, "ball joints"}, {Link::rod, "rods"}};
    for (const auto& [kind, name] : kinds) {
        for (const double ratio : {1e3, 1e4, 1e5}) {
            const std::string what = fmt::format("{}D, {}, {:.0f} : 1", D, name, ratio);
            add_hanging<D>(results, what, kind, ratio);
            add_swinging<D>(results, what, kind, ratio);
        }
    }
}

/// Forty rods between two points a metre apart, 1.2 m long together, come to rest.
template <int D>
void add_catenary(std::vector<Result>& results) {
    constexpr int rods = 40;
    constexpr double whole = 1.2, span = 1, length = whole / rods;
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    const double half = 0.5 * whole, slope = std::acos(0.5 * span / half);
    std::optional<BodyId<D>> before;
    Vec<D> from{};
    std::vector<BodyId<D>> bodies;
    for (int i = 0; i <= rods; ++i) {
        JointDefinition<D> joint;
        joint.kind = HingeJoint<D>{.anchor = from};
        if (i == rods) {
            joint.b = *before;
            world.add_joint(joint);
            break;
        }
        const double angle = i < rods / 2 ? -slope : slope;
        const Vec<D> way = length * in_plane<D>(std::cos(angle), std::sin(angle));
        const Vec<D> end = 0.45 * way;
        BodyDefinition<D> rod = body_at<D>(from + 0.5 * way, Capsule<D>{-end, end, 0.002}, 0.03);
        rod.linear_damping = rod.angular_damping = 1;
        joint.a = before;
        joint.b = world.add_body(rod);
        world.add_joint(joint);
        before = joint.b;
        bodies.push_back(joint.b);
        from += way;
    }
    run_until(world, 20);
    const Vec<D> left = world.position(bodies[rods / 2 - 1]), right = world.position(bodies[rods / 2]);
    // The lowest point is the joint in the middle; the rods on both sides rise from there alike.
    const JointId<D> middle = world.joints()[rods / 2];
    results.push_back(relative(fmt::format("{}D, catenary: sag (m)", D), 0.292438068,
                               -world.anchors(middle)[0].y, {1e-2, 1e-4}));
    results.push_back(
        absolute(fmt::format("{}D, catenary: asymmetry (m)", D), 0, left.y - right.y, {1e-3, 1e-5}));
}

}  // namespace

std::vector<Result> heavy_end() {
    std::vector<Result> results;
    add_heavy_ends<2>(results);
    add_heavy_ends<3>(results);
    add_catenary<2>(results);
    add_catenary<3>(results);
    return results;
}

}  // namespace carom::app
