#include "dynamics/forces.hpp"

#include <cmath>

namespace carom::detail {

namespace {

template <int D>
bool dynamic(const BodyMass<D>& mass) {
    return mass.inverse_mass > 0;
}

template <int D>
void push(Load<D>& load, const Vec<D>& force, const Vec<D>& arm) {
    load.force += force;
    load.torque += cross(arm, force);
}

/// What each kind of generator does; those that act on all act on the listed bodies with an inverse mass.
template <int D>
struct Act {
    const BodyView<D>& bodies;
    std::span<const std::uint32_t> listed;
    std::span<Load<D>> loads;

    Vec<D> arm(std::uint32_t i, const Vec<D>& point_in_body) const {
        return rotate(bodies.states[i].rotation, point_in_body - bodies.masses[i].center);
    }

    void operator()(const ConstantForce<D>& f) const {
        const std::uint32_t i = f.body.index;
        if (!dynamic(bodies.masses[i])) return;
        const Vec<D> force = f.local ? rotate(bodies.states[i].rotation, f.value) : f.value;
        push(loads[i], force, f.point ? arm(i, *f.point) : Vec<D>{});
    }
    void operator()(const ConstantTorque<D>& t) const {
        if (dynamic(bodies.masses[t.body.index])) loads[t.body.index].torque += t.value;
    }
    void operator()(const TimedImpulse<D>&) const {}
    void operator()(const Buoyancy<D>&) const {}
    void operator()(const Drag<D>& d) const {
        if (d.body) return drag(d, d.body->index);
        for (const std::uint32_t i : listed) drag(d, i);
    }
    void drag(const Drag<D>& d, std::uint32_t i) const {
        if (!dynamic(bodies.masses[i])) return;
        const Vec<D> v = bodies.states[i].velocity;
        loads[i].force -= (d.linear + d.quadratic * length(v)) * v;
    }
    void operator()(const Wind<D>& w) const {
        for (const std::uint32_t i : listed) {
            if (!dynamic(bodies.masses[i])) continue;
            const Vec<D> u = w.velocity - bodies.states[i].velocity;
            loads[i].force += (0.5 * w.density * bodies.masses[i].cross_section * length(u)) * u;
        }
    }
    void operator()(const PointGravity<D>& g) const {
        for (const std::uint32_t i : listed) {
            if (!dynamic(bodies.masses[i])) continue;
            const Vec<D> r = bodies.states[i].position - g.center;
            const double d = length(r);
            if (d > 0) loads[i].force -= (bodies.masses[i].mass * g.gm / (d * d * d)) * r;
        }
    }
    void operator()(const Spring<D>& s) const {
        const Pull p = pull(bodies, s);
        const double d = length(p.line);
        if (d == 0) return;
        const Vec<D> along = p.line / d;
        const Vec<D> force = (s.stiffness * (d - *s.length) + s.damping * dot(p.speed, along)) * along;
        if (s.a && dynamic(bodies.masses[s.a->index])) push(loads[s.a->index], force, p.arm_a);
        if (dynamic(bodies.masses[s.b.index])) push(loads[s.b.index], -force, p.arm_b);
    }

    /// Geometry of a spring: the line from anchor to anchor and how fast it changes.
    struct Pull {
        Vec<D> line{}, speed{}, arm_a{}, arm_b{};
    };
    static Pull pull(const BodyView<D>& bodies, const Spring<D>& s) {
        const auto end = [&](std::uint32_t i, const Vec<D>& anchor, Vec<D>& arm, Vec<D>& velocity) {
            const BodyState<D>& state = bodies.states[i];
            arm = rotate(state.rotation, anchor - bodies.masses[i].center);
            velocity = state.velocity + cross(state.angular_velocity, arm);
            return state.position + arm;
        };
        Pull p;
        Vec<D> from = s.anchor_a, from_velocity{}, to_velocity{};
        if (s.a) from = end(s.a->index, s.anchor_a, p.arm_a, from_velocity);
        p.line = end(s.b.index, s.anchor_b, p.arm_b, to_velocity) - from;
        p.speed = to_velocity - from_velocity;
        return p;
    }
};

template <int D>
bool names(const ForceDefinition<D>& definition, BodyId<D> body) {
    return std::visit(
        [&](const auto& kind) {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, Spring<D>>) {
                return kind.b == body || kind.a == body;
            } else if constexpr (requires { kind.body; }) {
                return kind.body == body;
            } else {
                return false;
            }
        },
        definition.kind);
}

}  // namespace

template <int D>
ForceId<D> Forces<D>::add(const ForceDefinition<D>& definition) {
    const std::uint32_t index = slots_.acquire();
    if (index == generators_.size()) generators_.emplace_back();
    generators_[index] = {definition, true, false};
    if (const auto* spring = std::get_if<Spring<D>>(&definition.kind); spring && spring->a)
        ties_.add(index, spring->a->index, spring->b.index);
    return slots_.template id<ForceId<D>>(index);
}

template <int D>
void Forces<D>::remove(ForceId<D> id) {
    const auto* spring = std::get_if<Spring<D>>(&generators_[id.index].definition.kind);
    if (spring && spring->a) ties_.remove(id.index);
    generators_[id.index] = {};
    slots_.release(id.index);
}

template <int D>
void Forces<D>::remove_all_of(BodyId<D> body) {
    for (std::uint32_t i = 0; i < generators_.size(); ++i) {
        if (generators_[i].in_use && names(generators_[i].definition, body))
            remove(slots_.template id<ForceId<D>>(i));
    }
}

template <int D>
void Forces<D>::add_loads(const BodyView<D>& bodies, std::span<const std::uint32_t> listed, double time,
                          std::span<Load<D>> loads) const {
    for (const Generator& g : generators_) {
        if (active(g, time)) std::visit(Act<D>{bodies, listed, loads}, g.definition.kind);
    }
}

template <int D>
std::vector<Buoyancy<D>> Forces<D>::waters(double time) const {
    std::vector<Buoyancy<D>> result;
    for (const Generator& g : generators_) {
        if (!active(g, time)) continue;
        if (const auto* water = std::get_if<Buoyancy<D>>(&g.definition.kind)) result.push_back(*water);
    }
    return result;
}

template <int D>
void Forces<D>::mark_fields(double time, std::span<const std::uint32_t> listed,
                            std::span<std::uint8_t> varies) const {
    for (const Generator& g : generators_) {
        if (!active(g, time)) continue;
        const auto& kind = g.definition.kind;
        const auto* drag = std::get_if<Drag<D>>(&kind);
        if (std::holds_alternative<Wind<D>>(kind) || std::holds_alternative<PointGravity<D>>(kind) ||
            (drag && !drag->body)) {
            for (const std::uint32_t i : listed) varies[i] = 1;
        } else if (drag) {
            varies[drag->body->index] = 1;
        } else if (const auto* spring = std::get_if<Spring<D>>(&kind)) {
            if (spring->a) varies[spring->a->index] = 1;
            varies[spring->b.index] = 1;
        } else if (const auto* force = std::get_if<ConstantForce<D>>(&kind);
                   force && (force->local || force->point)) {
            varies[force->body.index] = 1;
        }
    }
}

template <int D>
double Forces<D>::potential(const BodyView<D>& bodies, double time) const {
    double sum = 0;
    for (const Generator& g : generators_) {
        if (!active(g, time)) continue;
        if (const auto* s = std::get_if<Spring<D>>(&g.definition.kind)) {
            const double stretch = length(Act<D>::pull(bodies, *s).line) - *s->length;
            sum += 0.5 * s->stiffness * stretch * stretch;
        } else if (const auto* p = std::get_if<PointGravity<D>>(&g.definition.kind)) {
            for (std::uint32_t i = 0; i < bodies.states.size(); ++i) {
                const double d = length(bodies.states[i].position - p->center);
                if (d > 0) sum -= bodies.masses[i].mass * p->gm / d;
            }
        }
    }
    return sum;
}

template class Forces<2>;
template class Forces<3>;

}  // namespace carom::detail
