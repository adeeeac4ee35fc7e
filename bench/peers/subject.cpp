#include "subject.hpp"

#include <algorithm>

#include "carom/error.hpp"
#include "refusals.hpp"

namespace carom::subject {
namespace {

constexpr EngineKind kinds[] = {{.name = "Carom", .is_carom = true},
                                {.name = "Box2D 2.4", .make_2 = peers::make_box2d},
                                {.name = "Chipmunk", .make_2 = peers::make_chipmunk},
                                {.name = "Bullet", .make_3 = peers::make_bullet},
                                {.name = "ODE", .make_3 = peers::make_ode}};
const EngineKind* current = &kinds[0];
bool refused_in[2] = {};  // by dimension, from 2

bool finite(double x) { return std::isfinite(x); }
bool finite(const Vec2& v) { return std::isfinite(v.x + v.y); }
bool finite(const Vec3& v) { return std::isfinite(v.x + v.y + v.z); }

}  // namespace

std::span<const EngineKind> engines() { return kinds; }
void put_to_the_test(const EngineKind& engine) { current = &engine; }
bool refused(int dimension) { return refused_in[dimension - 2]; }
void forget_refusals() { refused_in[0] = refused_in[1] = false; }

template <int D>
World<D>::World(const WorldDefinition<D>& definition) : Base(definition) {
    if (current->is_carom) return;
    if (!current->has(D)) {
        // An engine of the other dimension: something has to be there that is never asked.
        refusal_ = "no worlds of this dimension";
        if constexpr (D == 2)
            engine_ = peers::make_box2d(definition);
        else
            engine_ = peers::make_bullet(definition);
        return;
    }
    if constexpr (D == 2)
        engine_ = current->make_2(definition);
    else
        engine_ = current->make_3(definition);
    if (definition.integrator != Integrator::semi_implicit_euler)
        attempt([] { throw peers::Unsupported("a choice of integrators"); });
}

template <int D>
void World<D>::attempt(const std::function<void()>& action) {
    if (!under_test()) return;
    try {
        action();
    } catch (const peers::Unsupported& unsupported) {
        refusal_ = unsupported.what();
        refused_in[D - 2] = true;
    }
}

template <int D>
void World<D>::set_gravity(const Vec<D>& gravity) {
    Base::set_gravity(gravity);
    attempt([&] { engine_->set_gravity(gravity); });
}

template <int D>
BodyId<D> World<D>::add_body(const BodyDefinition<D>& definition) {
    const BodyId<D> body = Base::add_body(definition);
    if (!engine_) return body;
    numbers_.resize(std::max<std::size_t>(numbers_.size(), body.index + 1));
    numbers_[body.index] = static_cast<int>(Base::bodies().size()) - 1;
    attempt([&] { engine_->add_body(definition, Base::mass_properties(body)); });
    if (definition.type != BodyType::fixed) moving_.push_back(body);
    return body;
}

template <int D>
JointId<D> World<D>::add_joint(const JointDefinition<D>& definition) {
    const JointId<D> joint = Base::add_joint(definition);
    attempt([&] {
        if (!definition.b) throw peers::Unsupported("joints of joints");
        engine_->add_joint(definition, definition.a ? index_of(*definition.a) : -1, index_of(definition.b));
    });
    return joint;
}

template <int D>
ForceId<D> World<D>::add_force(const ForceDefinition<D>& definition) {
    forces_.push_back(definition);
    return Base::add_force(definition);
}

template <int D>
void World<D>::remove_body(BodyId<D> body) {
    Base::remove_body(body);
    std::erase(moving_, body);
    attempt([] { throw peers::Unsupported("bodies that are removed"); });
}

template <int D>
void World<D>::set_velocity(BodyId<D> body, const Vec<D>& velocity) {
    seen();
    Base::set_velocity(body, velocity);
    attempt([&] { engine_->set_velocity(index_of(body), velocity, Base::angular_velocity(body)); });
}

template <int D>
void World<D>::apply_force(BodyId<D> body, const Vec<D>& force) {
    if (!engine_) return Base::apply_force(body, force);
    attempt([&] { engine_->apply_force(index_of(body), force, Angular<D>{}); });
}

template <int D>
void World<D>::apply_torque(BodyId<D> body, const Angular<D>& torque) {
    if (!engine_) return Base::apply_torque(body, torque);
    attempt([&] { engine_->apply_force(index_of(body), {}, torque); });
}

template <int D>
void World<D>::put_to_sleep(BodyId<D> body) {
    Base::put_to_sleep(body);
    attempt([&] { engine_->put_to_sleep(index_of(body)); });
}

/// Carom takes as many sub-steps within a step as the definition says, 4 by default. Where a case asks for
/// more, the other engine gets as many more steps.
template <int D>
void World<D>::step(double dt) {
    if (!engine_) return Base::step(dt);
    // Who waits for something to happen in a world without answers, or where all fell asleep, waits for ever.
    constexpr double patience = 2000;  // s
    if (time_ > patience) throw peers::Unsupported("an end to this");
    const int parts = std::max(1, Base::definition().substeps / 4);
    for (int part = 0; part < parts && under_test(); ++part) {
        push();
        attempt([&] { engine_->step(dt / parts); });
        seen_ = false;
    }
    time_ += dt;
}

template <int D>
Vec<D> World<D>::place_of(const std::optional<BodyId<D>>& body, const Vec<D>& anchor) const {
    return body ? apply(Base::transform(*body), anchor) : anchor;
}

template <int D>
Vec<D> World<D>::velocity_of(const std::optional<BodyId<D>>& body, const Vec<D>& place) const {
    return body ? Base::velocity_at(*body, place) : Vec<D>{};
}

/// Generators of forces act on the engine's bodies as constant forces through a step.
template <int D>
void World<D>::push() {
    if (forces_.empty()) return;
    seen();
    for (const ForceDefinition<D>& force : forces_) attempt([&] { push(force); });
}

template <int D>
void World<D>::push(const ForceDefinition<D>& definition) {
    if (const auto* spring = std::get_if<Spring<D>>(&definition.kind); spring && spring->length) {
        const Vec<D> a = place_of(spring->a, spring->anchor_a), b = place_of(spring->b, spring->anchor_b);
        const double distance = length(b - a);
        if (distance == 0) return;
        const Vec<D> along = (b - a) / distance;
        const double rate = dot(velocity_of(spring->b, b) - velocity_of(spring->a, a), along);
        const Vec<D> on_b =
            -(spring->stiffness * (distance - *spring->length) + spring->damping * rate) * along;
        if (length(b - Base::center_of_mass(spring->b)) > 1e-12 || spring->a)
            throw peers::Unsupported("springs between bodies, or off the centre of mass");
        engine_->apply_force(index_of(spring->b), on_b, Angular<D>{});
    } else if (const auto* point = std::get_if<PointGravity<D>>(&definition.kind)) {
        for (const BodyId<D> body : moving_) {
            const Vec<D> way = Base::center_of_mass(body) - point->center;
            const double distance = length(way);
            const double mass = Base::mass_properties(body).mass;
            engine_->apply_force(index_of(body), (-mass * point->gm / (distance * distance * distance)) * way,
                                 Angular<D>{});
        }
    } else {
        throw peers::Unsupported("a force of this kind");
    }
}

template <int D>
const carom::World<D>& World<D>::seen() const {
    if (seen_ || !engine_) return *this;
    seen_ = true;
    Base& ours = const_cast<World&>(*this);
    for (const BodyId<D> body : moving_) {
        const peers::BodyState<D> state = engine_->state(index_of(body));
        if (!finite(state.placed.position) || !finite(state.velocity) || !finite(state.spin) ||
            length(state.placed.position) > 1e9 || length(state.velocity) > 1e9) {
            blown_up_ = true;
            return *this;
        }
        ours.set_transform(body, state.placed);
        ours.set_velocity(body, state.velocity);
        ours.set_angular_velocity(body, state.spin);
    }
    return *this;
}

template <int D>
Counts World<D>::counts() const {
    Counts counts = Base::counts();
    if (!engine_) return counts;
    counts.awake = 0;
    for (const BodyId<D> body : moving_) counts.awake += !under_test() || engine_->awake(index_of(body));
    return counts;
}

template <int D>
Vec<D> World<D>::joint_force(JointId<D> joint) const {
    Vec<D> force = Base::joint_force(joint);
    if (engine_)
        for (int i = 0; i < D; ++i) force[i] = std::numeric_limits<double>::quiet_NaN();
    return force;
}

template class World<2>;
template class World<3>;

}  // namespace carom::subject
