#include "builders.hpp"

namespace carom {
namespace {

using test::spin;
using test::vec;

template <class T>
class FastJoints : public testing::Test {};
TYPED_TEST_SUITE(FastJoints, test::BothDimensions);

/// Two rods on a joint at their ends, which turn by several turns a step: nothing can follow that, but
/// nothing may fly apart or gain energy either.
TYPED_TEST(FastJoints, SpinsOfSeveralTurnsAStepGainNoEnergy) {
    constexpr int D = TypeParam::value;
    for (const double speed : {150.0, 250.0, 500.0, 2000.0, 20000.0}) {
        WorldDefinition<D> definition;
        definition.gravity = {};
        World<D> world(definition);
        BodyDefinition<D> rod;
        rod.shapes.push_back({Capsule<D>{vec<D>(-0.15, 0), vec<D>(0.15, 0), 0.05}});
        rod.angular_velocity = spin<D>(speed);
        const BodyId<D> a = world.add_body(rod);
        rod.position = vec<D>(0.4, 0);
        rod.angular_velocity = spin<D>(-0.3 * speed);
        const BodyId<D> b = world.add_body(rod);
        JointDefinition<D> joint;
        joint.kind = BallJoint<D>{.anchor = vec<D>(0.2, 0)};
        joint.a = a;
        joint.b = b;
        world.add_joint(joint);
        const double start = world.energy().kinetic;
        for (int i = 0; i < 120; ++i) {
            world.step(test::frame_time);
            ASSERT_TRUE(world.quarantined().empty()) << speed << " rad/s, step " << i;
            ASSERT_LT(world.energy().kinetic, 1.01 * start) << speed << " rad/s, step " << i;
        }
    }
}

}  // namespace
}  // namespace carom
