#pragma once

#include "solver/passes.hpp"
#include "solver/remake.hpp"

/// The passes written out for a lane type. Included by one source file for each width, which is compiled for
/// the instructions that the width needs. `flatten` puts all arithmetic into the loop, so that what is held
/// in registers stays there.
namespace carom::detail {

template <int D, class F>
struct PassesIn {
    using Rows = ContactRows<D, F>;
    using Marks = ContactMarks<D, F>;
    static constexpr int width = lane_count<F>;

    static SubStep<F> widen(const SubStep<float>& s) {
        const auto widen = [](const Softness<float>& soft) {
            return Softness<F>{F(soft.bias_rate), F(soft.mass_scale), F(soft.impulse_scale)};
        };
        return {F(s.inverse_length), F(s.push_speed), widen(s.soft), widen(s.firm)};
    }

    static Extras extras_of(std::uint8_t traits) {
        return {(traits & some_round) != 0, (traits & some_rolling) != 0, (traits & some_belts) != 0};
    }

    CAROM_INLINE static void write_velocities(const RecordView<D>& bodies, const BlockSpan<D>& span,
                                              std::size_t k, const Body<D, F>& a, const Body<D, F>& b) {
        const bool fixed = span.traits[k] & some_fixed;
        scatter_velocity_at<record_unit>(bodies, span.a + k * width, a, fixed);
        scatter_velocity_at<record_unit>(bodies, span.b + k * width, b, fixed);
    }

    /// `work(block, rows, a, b, extras)` for each block, with its bodies read before and written after.
    template <class Work>
    CAROM_INLINE static void each_block(const BlockSpan<D>& span, const RecordView<D>& bodies, Work work) {
        Rows* rows = reinterpret_cast<Rows*>(span.rows);
        for (std::size_t k = 0; k < span.blocks; ++k) {
            Body<D, F> a = gather_records<F>(bodies, span.a + k * width),
                       b = gather_records<F>(bodies, span.b + k * width);
            work(k, rows[k], a, b, extras_of(span.traits[k]));
            write_velocities(bodies, span, k, a, b);
        }
    }

    static void refresh(const BlockSpan<D>& span, const PoseView<D>& poses, const float* for_lanes,
                        float reach) {
        Rows* rows = reinterpret_cast<Rows*>(span.rows);
        Marks* marks = reinterpret_cast<Marks*>(span.marks);
        for (std::size_t k = 0; k < span.blocks; ++k) {
            const Pose<D, F> a = gather_pose<F>(poses, span.body_a + k * width),
                             b = gather_pose<F>(poses, span.body_b + k * width);
            auto found = detail::refresh(rows[k], marks[k], a, b, F(reach));
            if constexpr (D == 2) {
                const auto wanted = both(found, marks[k].can_be_remade > F(0));
                if (any(wanted)) {
                    LaneOutline<F> of_a, of_b;
                    gather_outline(for_lanes, span.shape_a + k * width, of_a);
                    gather_outline(for_lanes, span.shape_b + k * width, of_b);
                    found = both(found, !remake(rows[k], marks[k], a, b, of_a, of_b, wanted, F(reach)));
                }
            }
            span.found[k] = bits_of(found);
        }
    }

    static void find_near(const ApartSpan& span, const PoseView<D>& poses, const float* for_lanes,
                          const ApartLimits<float>& limits) {
        auto* marks = reinterpret_cast<ApartMarks<D, F>*>(span.marks);
        const ApartLimits<F> wide{F(limits.reach), F(limits.slow_way), F(limits.dt), F(limits.falling)};
        for (std::size_t k = 0; k < span.blocks; ++k) {
            const std::uint32_t *body_a = span.body_a + k * width, *body_b = span.body_b + k * width;
            const Pose<D, F> a = gather_pose<F>(poses, body_a), b = gather_pose<F>(poses, body_b);
            const Speeds<D, F> speed_a = gather_speeds<F>(poses, body_a),
                               speed_b = gather_speeds<F>(poses, body_b);
            auto found = may_touch(marks[k], a, b, speed_a, speed_b, wide);
            if constexpr (D == 2) {
                const auto wanted = both(found, marks[k].can_be_remade > F(0));
                if (any(wanted)) {
                    LaneOutline<F> of_a, of_b;
                    gather_outline(for_lanes, span.shape_a + k * width, of_a);
                    gather_outline(for_lanes, span.shape_b + k * width, of_b);
                    look_again(marks[k], a, b, of_a, of_b, wanted, wide.reach);
                    found = both(found, may_touch(marks[k], a, b, speed_a, speed_b, wide));
                }
            }
            span.found[k] = bits_of(found);
        }
    }

    static void prepare(const BlockSpan<D>& span, const RecordView<D>& bodies) {
        each_block(span, bodies,
                   [&](std::size_t k, Rows& rows, Body<D, F>& a, Body<D, F>& b, Extras extras)
                       CAROM_INLINE_LAMBDA {
                           weigh_rows(rows, a.weight, b.weight, extras);
                           detail::warm_start(rows, a.motion, b.motion, a.weight, b.weight, extras);
                           rows.lead = F(0);
                           const bool in_flight = any(is_in_flight(rows));
                           span.traits[k] = static_cast<std::uint8_t>((span.traits[k] & ~some_in_flight) |
                                                                      (in_flight ? some_in_flight : 0));
                           span.found[k] = bits_of(both(some_used(rows), !pushes(rows)));
                       });
    }

    static void warm_start(const BlockSpan<D>& span, const RecordView<D>& bodies) {
        each_block(span, bodies,
                   [](std::size_t, const Rows& rows, Body<D, F>& a, Body<D, F>& b, Extras extras)
                       CAROM_INLINE_LAMBDA {
                           detail::warm_start(rows, a.motion, b.motion, a.weight, b.weight, extras);
                       });
    }

    static void look_ahead(const BlockSpan<D>& span, const RecordView<D>& bodies, float h) {
        Rows* rows = reinterpret_cast<Rows*>(span.rows);
        for (std::size_t k = 0; k < span.blocks; ++k) {
            if (!(span.traits[k] & some_in_flight)) continue;
            const Body<D, F> a = gather_records<F>(bodies, span.a + k * width),
                             b = gather_records<F>(bodies, span.b + k * width);
            detail::look_ahead(rows[k], Vec<D, F>(b.motion.v - a.motion.v),
                               Vec<D, F>(b.motion.moved - a.motion.moved), F(h));
        }
    }

    template <bool biased, bool friction, bool tallied>
    static void solve(const BlockSpan<D>& span, const RecordView<D>& bodies, const SubStep<float>& step) {
        const SubStep<F> sub = widen(step);
        each_block(span, bodies,
                   [&](std::size_t k, Rows& rows, Body<D, F>& a, Body<D, F>& b, Extras extras)
                       CAROM_INLINE_LAMBDA {
                           if constexpr (tallied) detail::tally(rows);
                           solve_normals<biased>(rows, a.motion, b.motion, a.weight, b.weight, sub, extras);
                           if constexpr (friction)
                               solve_friction(rows, a.motion, b.motion, a.weight, b.weight, extras);
                           else
                               span.found[k] = bits_of(pushes(rows));
                       });
    }

    static void touch(const BlockSpan<D>& span) {
        const Rows* rows = reinterpret_cast<const Rows*>(span.rows);
        Marks* marks = reinterpret_cast<Marks*>(span.marks);
        for (std::size_t k = 0; k < span.blocks; ++k)
            span.found[k] = bits_of(detail::touch(rows[k], marks[k]));
    }

    static void tally(const BlockSpan<D>& span) {
        Rows* rows = reinterpret_cast<Rows*>(span.rows);
        for (std::size_t k = 0; k < span.blocks; ++k) detail::tally(rows[k]);
    }

    /// `work(body, drive)` for each block of bodies.
    template <class Work>
    CAROM_INLINE static void each_body(const BodySpan<D>& span, bool velocities, bool ways, Work work) {
        Drive<D, F>* drives = reinterpret_cast<Drive<D, F>*>(span.drives);
        std::uint32_t slots[width];
        for (std::size_t k = span.blocks.begin; k < span.blocks.end; ++k) {
            for (int lane = 0; lane < width; ++lane)
                slots[lane] = static_cast<std::uint32_t>(k * width + lane);
            Body<D, F> body = gather<F>(span.view, slots);
            work(body.motion, drives[k]);
            if (velocities) scatter_velocity(span.view, slots, body, false);
            if (ways) scatter_way(span.view, slots, body);
        }
    }

    static void load(const BodySpan<D>& span, const BodySource<D>& source) {
        Drive<D, F>* drives = reinterpret_cast<Drive<D, F>*>(span.drives);
        std::uint32_t slots[width];
        for (std::size_t k = span.blocks.begin; k < span.blocks.end; ++k) {
            for (int lane = 0; lane < width; ++lane)
                slots[lane] = static_cast<std::uint32_t>(k * width + lane);
            const auto wanted = load_lanes<F>(source.present + k * width) > F(0.5f);
            Body<D, F> body;
            take_up(gather_plain<F>(source, source.bodies + k * width), wanted, body, drives[k]);
            write_record(span.view, slots, body);
        }
    }

    static void store(const BodySpan<D>& span, const BodySource<D>& to) {
        const Drive<D, F>* drives = reinterpret_cast<const Drive<D, F>*>(span.drives);
        std::uint32_t slots[width];
        for (std::size_t k = span.blocks.begin; k < span.blocks.end; ++k) {
            float* present = to.present + k * width;
            for (int lane = 0; lane < width; ++lane)
                slots[lane] = static_cast<std::uint32_t>(k * width + lane);
            const auto wanted = load_lanes<F>(present) > F(0.5f);
            if (!any(wanted)) continue;
            const Motion<D, F> motion = gather<F>(span.view, slots).motion;
            const auto done = put_down(to, to.bodies + k * width, motion, drives[k], wanted);
            const std::uint32_t left = bits_of(both(wanted, !done));
            for (int lane = 0; left >> lane; ++lane) {
                if (left >> lane & 1) present[lane] = 0;
            }
        }
    }

    static void begin_warm(const BodySpan<D>& span, float h) {
        each_body(span, true, true, [h](Motion<D, F>& m, Drive<D, F>& d) CAROM_INLINE_LAMBDA {
            detail::begin_warm(m, d, F(h));
            m.v = d.change;
            m.moved = d.acceleration;
        });
    }

    static void begin(const BodySpan<D>& span, float) {
        each_body(span, true, true, [](Motion<D, F>& m, Drive<D, F>& d) CAROM_INLINE_LAMBDA {
            m = {d.start, d.start_spin, {}, {}};
        });
    }

    static void integrate_velocities(const BodySpan<D>& span, float h) {
        each_body(span, true, false, [h](Motion<D, F>& m, Drive<D, F>& d) CAROM_INLINE_LAMBDA {
            integrate_velocity(m, d, F(h));
        });
    }

    static void integrate_positions(const BodySpan<D>& span, float h) {
        each_body(span, false, true,
                  [h](Motion<D, F>& m, Drive<D, F>&) CAROM_INLINE_LAMBDA { integrate_position(m, F(h)); });
    }

    static void finish(const BodySpan<D>& span, float h) {
        each_body(span, false, true,
                  [h](Motion<D, F>& m, Drive<D, F>& d) CAROM_INLINE_LAMBDA { detail::finish(m, d, F(h)); });
    }

    static void finish_and_integrate_velocities(const BodySpan<D>& span, float h) {
        each_body(span, true, true, [h](Motion<D, F>& m, Drive<D, F>& d) CAROM_INLINE_LAMBDA {
            detail::finish(m, d, F(h));
            integrate_velocity(m, d, F(h));
        });
    }

    static constexpr Passes<D> all{width,
                                   refresh,
                                   find_near,
                                   prepare,
                                   warm_start,
                                   look_ahead,
                                   solve<true, false, false>,
                                   solve<true, false, true>,
                                   solve<true, true, false>,
                                   solve<false, true, false>,
                                   tally,
                                   touch,
                                   load,
                                   store,
                                   begin_warm,
                                   begin,
                                   integrate_velocities,
                                   integrate_positions,
                                   finish,
                                   finish_and_integrate_velocities};
};

}  // namespace carom::detail
