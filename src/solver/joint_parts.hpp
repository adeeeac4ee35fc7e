#pragma once

#include "solver/drive.hpp"
#include "solver/joint_rows.hpp"

/// One pass over a joint, part by part. Each part says what its kept impulses are on the bodies now, and
/// solves its rows.
namespace carom::detail {

/// A joint in the middle of a pass.
template <bool biased, int D, class F, Layout L>
struct JointPass {
    JointRows<D, F, L>& rows;
    Link<D, F> link;
    const JointStep<F>& step;
    Turning<D, F> turn_a, turn_b;
    Geometry<D, F> g{};

    CAROM_INLINE JointPass(JointRows<D, F, L>& all, Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                           const Weight<D, F>& wb, const JointStep<F>& sub)
        : rows(all),
          link{a, b, wa, wb, all.wrench},
          step(sub),
          turn_a(a, sub.again ? F(0) : sub.h),
          turn_b(b, sub.again ? F(0) : sub.h) {
        if constexpr (has_anchors(L)) g = geometry<biased>(rows.anchors, turn_a, turn_b, a, b);
    }

    CAROM_INLINE void run() {
        if constexpr (biased) {
            if (!step.again) re_aim();
        }
        drive<0>();
        drive<1>();
        drive<2>();
        drive<3>();
        drive<4>();
        drive<5>();
        solve_angular();
        solve_linear();
    }

    /// Replaces what the kept impulses were on the bodies by what they are along the new directions, as far
    /// as they are steady (see `steady_share`).
    CAROM_INLINE void re_aim() {
        const Wrench<D, F> old = rows.wrench;
        add(rows.total, old);
        keep(steady_share(link.likeness(old, old), link.likeness(old, rows.before)));
        rows.before = old;
        Wrench<D, F> now = linear_wrench();
        add(now, angular_wrench());
        if constexpr (L.drive_count > 0) add(now, wrench_of<0>(rows.kept.drives[0].sum()));
        if constexpr (L.drive_count > 1) add(now, wrench_of<1>(rows.kept.drives[1].sum()));
        if constexpr (L.drive_count > 2) add(now, wrench_of<2>(rows.kept.drives[2].sum()));
        if constexpr (L.drive_count > 3) add(now, wrench_of<3>(rows.kept.drives[3].sum()));
        if constexpr (L.drive_count > 4) add(now, wrench_of<4>(rows.kept.drives[4].sum()));
        if constexpr (L.drive_count > 5) add(now, wrench_of<5>(rows.kept.drives[5].sum()));
        link.add({now.force - old.force, now.on_a - old.on_a, now.on_b - old.on_b});
        rows.wrench = now;
    }

  private:
    /// Keeps only a share of the impulses.
    CAROM_INLINE void keep(F share) {
        auto& kept = rows.kept;
        if constexpr (L.linear == LinearPart::line) {
            for (F& p : kept.linear) p = p * share;
        } else if constexpr (L.linear != LinearPart::none) {
            kept.linear = kept.linear * share;
        }
        if constexpr (L.angular == AngularPart::held) {
            kept.angular.spring = kept.angular.spring * share;
            kept.angular.friction = kept.angular.friction * share;
        } else if constexpr (L.angular != AngularPart::none) {
            kept.angular = kept.angular * share;
        }
        if constexpr (L.drive_count > 0) {
            for (DriveImpulses<F>& d : kept.drives)
                d = {d.spring * share, d.motor * share, d.low * share, d.high * share};
        }
    }

    CAROM_INLINE static void add(Wrench<D, F>& sum, const Wrench<D, F>& w) {
        sum.force += w.force;
        sum.on_a = sum.on_a + w.on_a;
        sum.on_b = sum.on_b + w.on_b;
    }
    CAROM_INLINE static Wrench<D, F> couple(const Angular<D, F>& l) { return {{}, l, l}; }

    /// The error of which this sub-step puts a share right.
    CAROM_INLINE F to_mend(F error) const { return step.share * cut_to(error, step.most_way); }
    template <class V>
    CAROM_INLINE V to_mend(const V& error) const {
        return step.share * cut_to(error, step.most_way);
    }

    // ---- Linear part ----

    CAROM_INLINE Wrench<D, F> linear_wrench() const {
        if constexpr (L.linear == LinearPart::none) {
            return {};
        } else if constexpr (L.linear == LinearPart::line) {
            Vec<D, F> p{};
            for (int i = 0; i < D - 1; ++i) p += rows.kept.linear[i] * across(i).middle;
            return g.at_b(p);
        } else {
            return g.at_anchors(rows.kept.linear);
        }
    }

    CAROM_INLINE Turned<D, F> across(int i) const { return turned<biased>(rows.linear.across[i], turn_a); }

    CAROM_INLINE void solve_linear() {
        if constexpr (L.linear == LinearPart::point) {
            const Vec<D, F> change = -point_impulse(link, g.arm_a.middle, g.arm_b.middle, g.speed(link));
            rows.kept.linear += change;
            link.push(g.at_anchors(change));
            if constexpr (biased)
                link.shift(
                    g.at_anchors(-point_impulse(link, g.arm_a.middle, g.arm_b.middle, to_mend(g.gap))));
        } else if constexpr (L.linear == LinearPart::held) {
            auto& held = rows.linear;
            if constexpr (biased) held.offset = held.spring.pull * g.gap + held.spring.keep * held.before;
            Vec<D, F>& p = rows.kept.linear;
            const Vec<D, F> next =
                cut_to(Vec<D, F>(held.spring.keep * p -
                                 point_impulse(link, g.arm_a.middle, g.arm_b.middle,
                                               Vec<D, F>(held.offset + held.spring.keep * g.speed(link)))),
                       held.spring.most);
            link.push(g.at_anchors(Vec<D, F>(next - p)));
            p = next;
            if constexpr (!biased) held.before = g.speed(link);
        } else if constexpr (L.linear == LinearPart::line) {
            solve_line();
        }
    }

    CAROM_INLINE void solve_line() {
        const Vec<D, F> arm_a = g.arm_a.middle + g.gap_middle;
        const Vec<D, F> speed = g.speed_along_line(link);
        auto& p = rows.kept.linear;
        if constexpr (D == 2) {
            const Turned<D, F> t = across(0);
            const F mass = inverse_or_zero(compliance(t.middle, arm_a, g.arm_b.middle, link.wa, link.wb));
            const F change = -(mass * dot(t.end, speed));
            p[0] = p[0] + change;
            link.push(g.at_b(change * t.middle));
            if constexpr (biased) link.shift(g.at_b(-(mass * to_mend(dot(t.now, g.gap))) * t.middle));
        } else {
            const Turned<D, F> s = across(0), t = across(1);
            const Vec<3, F> as = cross(arm_a, s.middle), at = cross(arm_a, t.middle);
            const Vec<3, F> bs = cross(g.arm_b.middle, s.middle), bt = cross(g.arm_b.middle, t.middle);
            const Vec<3, F> mass = link.wa.mass + link.wb.mass, ias = link.wa.inertia * as,
                            ibs = link.wb.inertia * bs;
            const F xx = dot(s.middle, each(mass, s.middle)) + dot(as, ias) + dot(bs, ibs);
            const F xy = dot(t.middle, each(mass, s.middle)) + dot(at, ias) + dot(bt, ibs);
            const F yy = dot(t.middle, each(mass, t.middle)) + dot(at, link.wa.inertia * at) +
                         dot(bt, link.wb.inertia * bt);
            const auto along_both = [&](const Vec<2, F>& v) CAROM_INLINE_LAMBDA {
                return g.at_b(v.x * s.middle + v.y * t.middle);
            };
            const Vec<2, F> change =
                -inverse_times(xx, xy, yy, Vec<2, F>{dot(s.end, speed), dot(t.end, speed)});
            p[0] = p[0] + change.x;
            p[1] = p[1] + change.y;
            link.push(along_both(change));
            if constexpr (biased)
                link.shift(along_both(
                    -inverse_times(xx, xy, yy, to_mend(Vec<2, F>{dot(s.now, g.gap), dot(t.now, g.gap)}))));
        }
    }

    // ---- Angular part ----

    CAROM_INLINE Wrench<D, F> angular_wrench() {
        if constexpr (L.angular == AngularPart::none) {
            return {};
        } else if constexpr (L.angular == AngularPart::held) {
            return couple(rows.kept.angular.spring + rows.kept.angular.friction);
        } else if constexpr (L.angular == AngularPart::square) {
            return couple(rows.kept.angular * square_axes().normal_middle);
        } else if constexpr (L.angular == AngularPart::across) {
            // What the axis, as it turned, brought along itself is no longer the joint's to hold.
            const Vec<3, F> axis = axis_a().middle;
            rows.kept.angular -= dot(axis, rows.kept.angular) * axis;
            return couple(rows.kept.angular);
        } else {
            return couple(rows.kept.angular);
        }
    }

    CAROM_INLINE Turned<3, F> axis_a() const { return turned<biased>(rows.angular.axis_a, turn_a); }
    CAROM_INLINE Turned<3, F> axis_b() const { return turned<biased>(rows.angular.axis_b, turn_b); }

    struct SquareAxes {
        Vec<3, F> normal_middle, normal_end;
        F error;
    };
    CAROM_INLINE SquareAxes square_axes() const {
        const Turned<3, F> a = axis_a(), b = axis_b();
        return {cross(b.middle, a.middle), cross(b.end, a.end), dot(a.now, b.now)};
    }

    CAROM_INLINE void solve_angular() {
        if constexpr (L.angular == AngularPart::locked) {
            Angular<D, F>& l = rows.kept.angular;
            const Angular<D, F> error = rows.angular.turn + relative_turn<D, F>(link.a.turned, link.b.turned);
            const Inertia<D, F> mass = inverse_or_zero(link.angular_compliance());
            const Angular<D, F> change = -(mass * link.spin());
            l = l + change;
            link.push(couple(change));
            if constexpr (biased) link.shift(couple(-(mass * to_mend(error))));
        } else if constexpr (L.angular == AngularPart::across) {
            solve_across();
        } else if constexpr (L.angular == AngularPart::square) {
            const SquareAxes axes = square_axes();
            F& l = rows.kept.angular;
            const F mass =
                inverse_or_zero(dot(axes.normal_middle, link.angular_compliance() * axes.normal_middle));
            const F change = -(mass * dot(axes.normal_end, link.spin()));
            l = l + change;
            link.push(couple(change * axes.normal_middle));
            if constexpr (biased) link.shift(couple(-(mass * to_mend(axes.error)) * axes.normal_middle));
        } else if constexpr (L.angular == AngularPart::held) {
            solve_held_turn();
        }
    }

    CAROM_INLINE void solve_across() {
        const Turned<3, F> a = axis_a();
        const Vec<3, F> b = rows.angular.axis_b + turn_b.change(rows.angular.axis_b);
        const auto [s, t] = tangents<3>(a.middle);
        const Symmetric3<F> k = link.angular_compliance();
        const Vec<3, F> ks = k * s;
        const Vec<3, F> spin = link.spin();
        const auto impulse = [&](const Vec<3, F>& wanted) CAROM_INLINE_LAMBDA {
            const Vec<2, F> l = inverse_times(dot(s, ks), dot(t, ks), dot(t, k * t),
                                              Vec<2, F>{dot(s, wanted), dot(t, wanted)});
            return -(l.x * s + l.y * t);
        };
        const Vec<3, F> change = impulse(spin - dot(a.end, spin) * a.end);
        rows.kept.angular += change;
        link.push(couple(change));
        if constexpr (biased) link.shift(couple(impulse(to_mend(cross(a.now, b)))));
    }

    CAROM_INLINE void solve_held_turn() {
        auto& held = rows.angular;
        const Inertia<D, F> mass = inverse_or_zero(link.angular_compliance());
        Angular<D, F>& l = rows.kept.angular.spring;
        if constexpr (biased) {
            const Angular<D, F> error = held.turn + relative_turn<D, F>(link.a.turned, link.b.turned);
            held.offset = held.spring.pull * error + held.spring.keep * held.before;
        }
        const Angular<D, F> next =
            cut_to(Angular<D, F>(held.spring.keep * l -
                                 mass * Angular<D, F>(held.offset + held.spring.keep * link.spin())),
                   held.spring.most);
        link.push(couple(Angular<D, F>(next - l)));
        l = next;
        Angular<D, F>& rub = rows.kept.angular.friction;
        const Angular<D, F> rubbed = cut_to(Angular<D, F>(rub - mass * link.spin()), held.friction);
        link.push(couple(Angular<D, F>(rubbed - rub)));
        rub = rubbed;
        if constexpr (!biased) held.before = link.spin();
    }

    // ---- Drives ----

    template <int i>
    CAROM_INLINE Turned<D, F> direction() const {
        if constexpr (L.drives[i] == DriveKind::stretch) {
            const auto unit = [](const Vec<D, F>& v) CAROM_INLINE_LAMBDA {
                // Where the anchors meet any direction is as good as another.
                const F squared = dot(v, v);
                const auto some = squared > F(1e-12f);
                Vec<D, F> u = v * (F(1) / square_root(select(some, squared, F(1))));
                u.x = select(some, u.x, F(1));
                return u;
            };
            return {unit(g.gap), unit(g.gap_middle), unit(g.gap_end)};
        } else if constexpr (L.drives[i] == DriveKind::turn && D == 2) {
            return {};
        } else {
            return turned<biased>(rows.drives[i].axis, turn_a);
        }
    }

    template <int i>
    CAROM_INLINE Wrench<D, F> along(const Turned<D, F>& n, F impulse) const {
        if constexpr (L.drives[i] == DriveKind::stretch) return g.at_anchors(impulse * n.middle);
        if constexpr (L.drives[i] == DriveKind::slide) return g.at_b(impulse * n.middle);
        if constexpr (L.drives[i] == DriveKind::turn && D == 2) return couple(impulse);
        if constexpr (L.drives[i] == DriveKind::turn && D == 3) return couple(impulse * n.middle);
    }

    template <int i>
    CAROM_INLINE Wrench<D, F> wrench_of(F impulse) const {
        return along<i>(direction<i>(), impulse);
    }

    template <int i>
    CAROM_INLINE F speed(const Turned<D, F>& n) const {
        if constexpr (L.drives[i] == DriveKind::stretch) return dot(n.end, g.speed(link));
        if constexpr (L.drives[i] == DriveKind::slide) return dot(n.end, g.speed_along_line(link));
        if constexpr (L.drives[i] == DriveKind::turn && D == 2) return link.spin();
        if constexpr (L.drives[i] == DriveKind::turn && D == 3) return dot(n.end, link.spin());
    }

    template <int i>
    CAROM_INLINE F effective_mass(const Turned<D, F>& n) const {
        if constexpr (L.drives[i] == DriveKind::stretch)
            return inverse_or_zero(compliance(n.middle, g.arm_a.middle, g.arm_b.middle, link.wa, link.wb));
        if constexpr (L.drives[i] == DriveKind::slide)
            return inverse_or_zero(compliance(n.middle, Vec<D, F>(g.arm_a.middle + g.gap_middle),
                                              g.arm_b.middle, link.wa, link.wb));
        if constexpr (L.drives[i] == DriveKind::turn && D == 2)
            return inverse_or_zero(link.angular_compliance());
        if constexpr (L.drives[i] == DriveKind::turn && D == 3)
            return inverse_or_zero(dot(n.middle, link.angular_compliance() * n.middle));
    }

    /// Of turns: since the start of the step.
    template <int i>
    CAROM_INLINE F coordinate(const Turned<D, F>& n) const {
        if constexpr (L.drives[i] == DriveKind::stretch) return dot(n.now, g.gap);
        if constexpr (L.drives[i] == DriveKind::slide) return dot(n.now, g.gap);
        const Angular<D, F> turn = relative_turn<D, F>(link.a.turned, link.b.turned);
        if constexpr (L.drives[i] == DriveKind::turn && D == 2) return turn;
        if constexpr (L.drives[i] == DriveKind::turn && D == 3)
            return F(0.5f) * dot(rows.drives[i].axis + n.now, turn);
    }

    /// A limit that lies `gap` away, with the row pointing away from it: the new impulse. The gap is left to
    /// close by itself. Without a range between the limits the row holds both ways.
    template <class Mask>
    CAROM_INLINE F limit(F gap, F approach, F mass, F old, Mask ranged) const {
        const F free = select(both(gap > F(0), ranged), gap * step.inverse_h, F(0));
        return maximum(select(ranged, F(0), F(-1e37f)), old - mass * (approach + free));
    }

    template <int i>
    CAROM_INLINE void drive() {
        if constexpr (i < L.drive_count) {
            auto& base = rows.drives[i];
            DriveImpulses<F>& kept = rows.kept.drives[i];
            const Turned<D, F> n = direction<i>();
            const F mass = effective_mass<i>(n), now = coordinate<i>(n), mobility = inverse_or_zero(mass);
            F rate = speed<i>(n);
            const auto set = [&](F& impulse, F next, F sign) CAROM_INLINE_LAMBDA {
                const F change = sign * (next - impulse);
                link.push(along<i>(n, change));
                rate = rate + mobility * change;
                impulse = next;
            };
            const SpringRow<F>& spring = base.spring;
            if constexpr (biased) base.offset = spring.pull * (now - base.rest) + spring.keep * base.before;
            set(kept.spring,
                cut_to(spring.keep * kept.spring - mass * (base.offset + spring.keep * rate), spring.most),
                F(1));
            set(kept.motor, cut_to(kept.motor - mass * (rate - base.motor_speed), base.motor_most), F(1));
            const auto ranged = base.high > base.low;
            const F above = now - base.low, below = select(ranged, base.high - now, F(1e18f));
            set(kept.low, limit(above, rate, mass, kept.low, ranged), F(1));
            set(kept.high, limit(below, -rate, mass, kept.high, base.low > F(-2e18f)), F(-1));
            if constexpr (biased) {
                const F error = select(ranged, minimum(above, F(0)) - minimum(below, F(0)), above);
                link.shift(along<i>(n, -(mass * to_mend(error))));
            }
            if constexpr (!biased) base.before = speed<i>(n);
        }
    }
};

}  // namespace carom::detail
