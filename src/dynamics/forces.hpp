#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/forces.hpp"
#include "core/adjacency.hpp"
#include "core/slots.hpp"
#include "dynamics/body.hpp"

namespace carom::detail {

/// The bodies as forces see them, by body index.
template <int D>
struct BodyView {
    std::span<const BodyState<D>> states;
    std::span<const BodyMass<D>> masses;
};

/// The generators of forces of a world.
template <int D>
class Forces {
  public:
    ForceId<D> add(const ForceDefinition<D>& definition);
    void remove(ForceId<D> id);
    /// Removes the generators that name the body.
    void remove_all_of(BodyId<D> body);
    bool contains(ForceId<D> id) const { return slots_.contains(id); }
    int count() const { return static_cast<int>(slots_.count()); }

    /// Adds to `loads` (by body index) what the generators do at `time` to the dynamic bodies that are
    /// listed; those of others are left in any state.
    void add_loads(const BodyView<D>& bodies, std::span<const std::uint32_t> listed, double time,
                   std::span<Load<D>> loads) const;

    /// What bodies float in at `time`; add_loads leaves that out.
    std::vector<Buoyancy<D>> waters(double time) const;

    /// Marks (by body index) the listed bodies whose load depends on where they are or how they move,
    /// waters aside.
    void mark_fields(double time, std::span<const std::uint32_t> listed,
                     std::span<std::uint8_t> varies) const;

    /// Applies the timed impulses that have come due: `hit(body, impulse, point in the body's frame or
    /// none)`.
    template <class Hit>
    void take_impulses(double time, Hit&& hit) {
        for (Generator& g : generators_) {
            const auto* blow =
                g.in_use && !g.fired ? std::get_if<TimedImpulse<D>>(&g.definition.kind) : nullptr;
            if (!blow || blow->at > time + time_tolerance) continue;
            g.fired = true;
            hit(blow->body, blow->value, blow->point);
        }
    }

    /// Visits the bodies on which a generator began or ceased to act between two times; `all()` instead when
    /// it acts on every body.
    template <class Visit, class All>
    void each_change(double before, double now, Visit&& visit, All&& all) const {
        for (const Generator& g : generators_) {
            if (active(g, before) == active(g, now)) continue;
            std::visit([&](const auto& kind) { visit_bodies(kind, visit, all); }, g.definition.kind);
        }
    }

    /// Visits the bodies that a spring ties to this one.
    template <class Visit>
    void each_tied(std::uint32_t body, Visit&& visit) const {
        ties_.each(body, [&](std::uint32_t, std::uint32_t other) { visit(other); });
    }

    /// Visits every generator, and whether its timed impulse has been given.
    template <class Visit>
    void each(Visit&& visit) const {
        for (const Generator& g : generators_) {
            if (g.in_use) visit(g.definition, g.fired);
        }
    }

    /// Energy stored in springs and point gravities, J. That of bodies in water is `energy_in_water`.
    double potential(const BodyView<D>& bodies, double time) const;

    /// Sums of time steps are rounded; a border that is met to this many seconds counts as met.
    static constexpr double time_tolerance = 1e-6;

  private:
    struct Generator {
        ForceDefinition<D> definition;
        bool in_use = false;
        bool fired = false;
    };
    template <class Kind, class Visit, class All>
    static void visit_bodies(const Kind& kind, Visit& visit, All& all) {
        if constexpr (std::is_same_v<Kind, Spring<D>>) {
            if (kind.a) visit(kind.a->index);
            visit(kind.b.index);
        } else if constexpr (std::is_same_v<Kind, Drag<D>>) {
            kind.body ? visit(kind.body->index) : all();
        } else if constexpr (requires { kind.body; }) {
            visit(kind.body.index);
        } else {
            all();
        }
    }
    static bool active(const Generator& g, double time) {
        return g.in_use && time >= g.definition.from - time_tolerance &&
               time < g.definition.to - time_tolerance;
    }

    Slots slots_;
    std::vector<Generator> generators_;
    Adjacency ties_;  ///< springs between two bodies, by generator
};

}  // namespace carom::detail
