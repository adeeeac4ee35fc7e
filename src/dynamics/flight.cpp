#include "dynamics/flight.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/crew.hpp"
#include "dynamics/buoyancy.hpp"
#include "math/trig.hpp"

namespace carom::detail {

Decay::Decay(double damping, double step) {
    const double z = damping * step;
    if (z == 0) return;
    factor = exp(-z);
    if (z < 0.05) {  // the quotients below would cancel: series of (1 − e⁻ᶻ)/z and (1 − phi1)/z
        phi1 = 1 - z / 2 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6 * (1 - z / 7)))));
        phi2 = 0.5 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6 * (1 - z / 7 * (1 - z / 8))))));
    } else {
        phi1 = (1 - factor) / z;
        phi2 = (1 - phi1) / z;
    }
}

template <int D>
void LoadModel<D>::begin(std::span<const BodyMass<D>> masses, std::size_t from, std::size_t to,
                         std::span<Load<D>> loads) const {
    for (const std::uint32_t i : bodies.subspan(from, to - from)) {
        const BodyMass<D>& m = masses[i];
        loads[i] = applied[i];
        loads[i].force += (m.mass * m.gravity_scale) * gravity;
    }
}

template <int D>
void LoadModel<D>::add(const BodyView<D>& view, double time, std::span<Load<D>> loads, double step) const {
    forces.add_loads(view, bodies, time, loads);
    const std::vector<Buoyancy<D>> waters = forces.waters(time);
    if (!waters.empty())
        add_buoyancy<D>({view.states, view.masses, solids, gravity, waters}, bodies, step, loads);
}

namespace {

/// v + 2w u×v + 2u×(u×v) is a rotation only for |q| = 1, and a unit quaternion's rounding is biased. Divided
/// by |q|² it is a rotation whatever the length, so that L → ω → L loses nothing step by step.
Vec3 turned(const Rotation3& q, const Vec3& v) {
    const Vec3 u{q.x, q.y, q.z};
    const Vec3 t = (2 / (dot(u, u) + q.w * q.w)) * cross(u, v);
    return v + q.w * t + cross(u, t);
}

/// ω of a body with angular momentum L in the world's axes.
Vec3 spin_of(const BodyMass<3>& mass, const Rotation3& rotation, const Vec3& momentum) {
    return turned(rotation, mass.inverse_inertia * turned(inverse(rotation), momentum));
}

/// q' = ½ ω q for a quaternion and the angular velocity in the world's axes.
Rotation3 rate(const Vec3& w, const Rotation3& q) {
    return Rotation3{0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0} * q;
}

Rotation3 moved(const Rotation3& q, const Rotation3& rate, double h) {
    return normalized(Rotation3{q.x + h * rate.x, q.y + h * rate.y, q.z + h * rate.z, q.w + h * rate.w});
}

/// Rotation of a body that precesses. The angular momentum L is the conserved quantity: it changes by the
/// torque alone, linearly in time, so |L| is kept to rounding. The orientation follows q' = ½ ω(q, L) q,
/// ω = R I⁻¹ Rᵀ L, by the classical fourth-order Runge–Kutta method in as many parts as keep the turn of each
/// below 0.1 rad, where its relative energy error is below 1e-9 a part.
void precess(BodyState<3>& state, const BodyMass<3>& mass, const Vec3& torque, double h) {
    if (state.angular_velocity == Vec3{} && torque == Vec3{}) return;
    const Rotation3 r = state.rotation;
    Vec3 momentum = turned(r, mass.inertia * turned(inverse(r), state.angular_velocity));
    const double turn_of_step = length(state.angular_velocity) * h;
    const int parts = std::clamp(static_cast<int>(turn_of_step / 0.1) + 1, 1, 1000);
    const double dt = h / parts;
    Rotation3 q = r;
    for (int i = 0; i < parts; ++i) {
        const Vec3 middle = momentum + (0.5 * dt) * torque;
        const Vec3 end = momentum + dt * torque;
        const Rotation3 k1 = rate(spin_of(mass, q, momentum), q);
        const Rotation3 q2 = moved(q, k1, 0.5 * dt);
        const Rotation3 k2 = rate(spin_of(mass, q2, middle), q2);
        const Rotation3 q3 = moved(q, k2, 0.5 * dt);
        const Rotation3 k3 = rate(spin_of(mass, q3, middle), q3);
        const Rotation3 q4 = moved(q, k3, dt);
        const Rotation3 k4 = rate(spin_of(mass, q4, end), q4);
        const Rotation3 mean{(k1.x + 2 * k2.x + 2 * k3.x + k4.x) / 6, (k1.y + 2 * k2.y + 2 * k3.y + k4.y) / 6,
                             (k1.z + 2 * k2.z + 2 * k3.z + k4.z) / 6,
                             (k1.w + 2 * k2.w + 2 * k3.w + k4.w) / 6};
        q = moved(q, mean, dt);
        momentum = end;
    }
    state.rotation = q;
    state.angular_velocity = spin_of(mass, q, momentum);
}

/// Does the rotation follow from ω' = I⁻¹ τ alone, as in the plane and for equal principal moments?
template <int D>
bool turns_simply(const BodyMass<D>& mass) {
    return D == 2 || mass.isotropic || mass.locks.rx || mass.locks.ry || mass.locks.rz;
}

/// One body while an integrator works on it: its accelerations under a load.
template <int D>
struct Pull {
    Vec<D> linear;
    Angular<D> angular;  ///< only where the body turns simply
};

template <int D>
Pull<D> pull(const BodyState<D>& state, const BodyMass<D>& mass, const Load<D>& load) {
    Pull<D> p{free_components<D>(mass.locks, load.force * mass.inverse_mass), {}};
    if (turns_simply<D>(mass)) p.angular = world_inverse_inertia<D>(mass, state.rotation) * load.torque;
    return p;
}

template <int D>
void semi_implicit_euler(const Flight<D>& f, std::span<const std::uint32_t> bodies) {
    const double h = f.step;
    // Most bodies decay like the one before.
    double damping = 0;
    Decay known(damping, h);
    const auto decay = [&](double wanted) {
        if (wanted != damping) known = Decay(damping = wanted, h);
        return known;
    };
    for (const std::uint32_t i : bodies) {
        BodyState<D>& s = f.states[i];
        const BodyMass<D>& m = f.masses[i];
        const Pull<D> a = pull(s, m, f.loads[i]);
        const Decay linear = decay(m.linear_damping), angular = decay(m.angular_damping);
        // Where the load is constant the motion has a closed form; elsewhere x += h v(new) is symplectic.
        const auto advance = [&](auto& v, const auto& acc, const Decay& d) {
            const auto before = v;
            v = v * d.factor + acc * (h * d.phi1);
            return f.varies[i] ? v * h : before * (h * d.phi1) + acc * (h * h * d.phi2);
        };
        s.position += advance(s.velocity, a.linear, linear);
        if (turns_simply<D>(m)) {
            turn<D>(s, advance(s.angular_velocity, a.angular, angular));
        } else if constexpr (D == 3) {
            precess(s, m, f.loads[i].torque, h);
            s.angular_velocity *= angular.factor;
        }
    }
}

/// The other integrators know nothing of damping: half of the decay before the step and half after it keep
/// second order (Strang 1968).
template <int D>
void decay_half(const Flight<D>& f) {
    for (const std::uint32_t i : f.bodies) {
        const BodyMass<D>& m = f.masses[i];
        f.states[i].velocity *= Decay(m.linear_damping, 0.5 * f.step).factor;
        f.states[i].angular_velocity =
            f.states[i].angular_velocity * Decay(m.angular_damping, 0.5 * f.step).factor;
    }
}

template <int D>
void explicit_euler(const Flight<D>& f) {
    const double h = f.step;
    for (const std::uint32_t i : f.bodies) {
        BodyState<D>& s = f.states[i];
        const BodyMass<D>& m = f.masses[i];
        const Pull<D> a = pull(s, m, f.loads[i]);
        s.position += h * s.velocity;
        s.velocity += h * a.linear;
        if (turns_simply<D>(m)) {
            const Angular<D> w = s.angular_velocity;
            turn<D>(s, w * h);
            s.angular_velocity = w + a.angular * h;
        } else if constexpr (D == 3) {
            precess(s, m, f.loads[i].torque, h);
        }
    }
}

/// Velocity Verlet (Swope et al. 1982): x += h v + ½ h² a(start), v += ½ h (a(start) + a(end)).
template <int D>
void verlet(const Flight<D>& f) {
    const double h = f.step;
    const std::vector<Load<D>> first(f.loads.begin(), f.loads.end());
    for (const std::uint32_t i : f.bodies) {
        BodyState<D>& s = f.states[i];
        const BodyMass<D>& m = f.masses[i];
        const Pull<D> a = pull(s, m, first[i]);
        s.position += h * s.velocity + (0.5 * h * h) * a.linear;
        s.velocity += h * a.linear;
        if (turns_simply<D>(m)) {
            turn<D>(s, s.angular_velocity * h + a.angular * (0.5 * h * h));
            s.angular_velocity = s.angular_velocity + a.angular * h;
        } else if constexpr (D == 3) {
            precess(s, m, first[i].torque, h);
        }
    }
    f.model.sum({f.states, f.masses}, f.time, f.loads);
    for (const std::uint32_t i : f.bodies) {
        if (!f.varies[i]) continue;
        BodyState<D>& s = f.states[i];
        const BodyMass<D>& m = f.masses[i];
        s.velocity +=
            free_components<D>(m.locks, (f.loads[i].force - first[i].force) * (0.5 * h * m.inverse_mass));
        s.angular_velocity = s.angular_velocity + world_inverse_inertia<D>(m, s.rotation) *
                                                      ((f.loads[i].torque - first[i].torque) * (0.5 * h));
    }
}

/// The classical fourth-order Runge–Kutta method, written for x'' = a (Nyström): all bodies go through each
/// stage together, so that forces between them see both ends at the same time.
template <int D>
void rk4(const Flight<D>& f) {
    const double h = f.step;
    const std::size_t n = f.bodies.size();
    std::vector<BodyState<D>> start(n);
    std::vector<Load<D>> loads[4];
    std::vector<Pull<D>> k[4];
    for (std::size_t j = 0; j < n; ++j) start[j] = f.states[f.bodies[j]];

    // Stage k is taken at time c h, with x = x0 + c h v0 + e h² a(k − 2) and v = v0 + c h a(k − 1).
    constexpr double c[4] = {0, 0.5, 0.5, 1}, e[4] = {0, 0, 0.25, 0.5};
    for (int stage = 0; stage < 4; ++stage) {
        const double ch = c[stage] * h, eh = e[stage] * h * h;
        for (std::size_t j = 0; j < n && stage > 0; ++j) {
            BodyState<D>& s = f.states[f.bodies[j]] = start[j];
            const BodyMass<D>& m = f.masses[f.bodies[j]];
            const Pull<D>& a = k[stage - 1][j];
            const Pull<D>& b = k[stage > 1 ? stage - 2 : 0][j];
            s.position += ch * s.velocity + eh * b.linear;
            s.velocity += ch * a.linear;
            if (turns_simply<D>(m)) {
                turn<D>(s, s.angular_velocity * ch + b.angular * eh);
                s.angular_velocity = s.angular_velocity + a.angular * ch;
            } else if constexpr (D == 3) {
                precess(s, m, loads[stage - 1][j].torque, ch);
            }
        }
        if (stage > 0) f.model.sum({f.states, f.masses}, f.time, f.loads);
        for (const std::uint32_t i : f.bodies) {
            loads[stage].push_back(f.loads[i]);
            k[stage].push_back(pull(f.states[i], f.masses[i], f.loads[i]));
        }
    }
    for (std::size_t j = 0; j < n; ++j) {
        BodyState<D>& s = f.states[f.bodies[j]] = start[j];
        const BodyMass<D>& m = f.masses[f.bodies[j]];
        s.position += h * s.velocity + (h * h / 6) * (k[0][j].linear + k[1][j].linear + k[2][j].linear);
        s.velocity += (h / 6) * (k[0][j].linear + 2.0 * (k[1][j].linear + k[2][j].linear) + k[3][j].linear);
        if (turns_simply<D>(m)) {
            turn<D>(s, s.angular_velocity * h +
                           (k[0][j].angular + k[1][j].angular + k[2][j].angular) * (h * h / 6));
            s.angular_velocity =
                s.angular_velocity +
                (k[0][j].angular + (k[1][j].angular + k[2][j].angular) * 2.0 + k[3][j].angular) * (h / 6);
        } else if constexpr (D == 3) {
            const Vec3 mean =
                (loads[0][j].torque + 2.0 * (loads[1][j].torque + loads[2][j].torque) + loads[3][j].torque) /
                6.0;
            precess(s, m, mean, h);
        }
    }
}

}  // namespace

template <int D>
void fly(const Flight<D>& flight, Integrator integrator, Scheduler* scheduler) {
    if (flight.bodies.empty()) return;
    if (integrator == Integrator::semi_implicit_euler) {
        constexpr std::size_t worth_a_worker = 128;
        return run_range(scheduler, flight.bodies.size(), worth_a_worker,
                         [&](std::size_t begin, std::size_t end) {
                             semi_implicit_euler(flight, flight.bodies.subspan(begin, end - begin));
                         });
    }
    decay_half(flight);
    switch (integrator) {
        case Integrator::explicit_euler:
            explicit_euler(flight);
            break;
        case Integrator::verlet:
            verlet(flight);
            break;
        default:
            rk4(flight);
            break;
    }
    decay_half(flight);
}

template <>
double coasting_spin<2>(const BodyState<2>& state, const BodyMass<2>&, double) {
    return state.angular_velocity;
}

template <>
Vec3 coasting_spin<3>(const BodyState<3>& state, const BodyMass<3>& mass, double step) {
    if (turns_simply<3>(mass)) return state.angular_velocity;
    BodyState<3> copy = state;
    precess(copy, mass, {}, step);
    return copy.angular_velocity;
}

template struct LoadModel<2>;
template struct LoadModel<3>;
template void fly(const Flight<2>&, Integrator, Scheduler*);
template void fly(const Flight<3>&, Integrator, Scheduler*);

}  // namespace carom::detail
