#pragma once

#include <array>
#include <utility>

#include "solver/joint_parts.hpp"
#include "solver/joint_passes.hpp"

/// The passes over joints written out for a lane type, like solver/passes_in_lanes.hpp.
namespace carom::detail {

template <int D, class F>
struct JointPassesIn {
    static constexpr int width = lane_count<F>;
    static constexpr std::array<std::uint32_t, 16> lane_numbers{0, 1, 2,  3,  4,  5,  6,  7,
                                                                8, 9, 10, 11, 12, 13, 14, 15};

    /// Writes how far the bodies have come, of those that can be pushed.
    CAROM_INLINE static void scatter_moved(const RecordView<D>& bodies, const std::uint32_t* slots,
                                           const Body<D, F>& body) {
        const Motion<D, F>& m = body.motion;
        const std::uint32_t first = bodies.first_movable;
        if constexpr (D == 2) {
            scatter_record_from(first, bodies.records + 4, slots, body_stride<2>, m.moved.x, m.moved.y,
                                m.turned, body.weight.inertia);
        } else {
            const Symmetric3<F>& i = body.weight.inertia;
            scatter_record_from(first, bodies.records + 8, slots, body_stride<3>, m.moved.x, m.moved.y,
                                m.moved.z, i.yy, m.turned.x, m.turned.y, m.turned.z, i.zz);
        }
    }

    template <class Rows, bool moves, class Work>
    CAROM_INLINE static void each_block(const JointSpan& span, const RecordView<D>& bodies, Work work) {
        Rows* rows = reinterpret_cast<Rows*>(span.rows);
        for (std::size_t k = 0; k < span.blocks; ++k) {
            const std::uint32_t *slots_a = span.a + k * width, *slots_b = span.b + k * width;
            Body<D, F> a = gather<F>(bodies, slots_a), b = gather<F>(bodies, slots_b);
            work(rows[k], a, b);
            const bool fixed = span.some_fixed[k] != 0;
            scatter_velocity(bodies, slots_a, a, fixed);
            scatter_velocity(bodies, slots_b, b, fixed);
            if constexpr (moves) {
                if (fixed) {
                    scatter_moved(bodies, slots_a, a);
                    scatter_moved(bodies, slots_b, b);
                } else {
                    scatter_way(bodies, slots_a, a);
                    scatter_way(bodies, slots_b, b);
                }
            }
        }
    }

    CAROM_INLINE static void gather_anchors(const double* from, Vec<2, Wide<F>>& a, Vec<2, Wide<F>>& b) {
        gather_pairs(from, lane_numbers.data(), 4, a.x, a.y);
        gather_pairs(from + 2, lane_numbers.data(), 4, b.x, b.y);
    }
    CAROM_INLINE static void gather_anchors(const double* from, Vec<3, Wide<F>>& a, Vec<3, Wide<F>>& b) {
        gather_pairs(from, lane_numbers.data(), 6, a.x, a.y);
        gather_pairs(from + 2, lane_numbers.data(), 6, a.z, b.x);
        gather_pairs(from + 4, lane_numbers.data(), 6, b.y, b.z);
    }
    CAROM_INLINE static Vec<D, F> rounded(const Vec<D, Wide<F>>& v) {
        Vec<D, F> r;
        for (int i = 0; i < D; ++i) r[i] = F(v[i]);
        return r;
    }

    /// In double precision, like `pose_of`.
    template <Layout L>
    static void place(const JointSpan& span, const JointSites<D>& sites) {
        auto* rows = reinterpret_cast<JointRows<D, F, L>*>(span.rows);
        const PoseView<D> poses{sites.states};
        for (std::size_t k = 0; k < span.blocks; ++k) {
            const Pose<D, F> a = gather_pose<F>(poses, sites.body_a + k * width),
                             b = gather_pose<F>(poses, sites.body_b + k * width);
            Vec<D, Wide<F>> anchor_a, anchor_b;
            gather_anchors(sites.anchors + k * width * JointSites<D>::anchor_stride, anchor_a, anchor_b);
            const Vec<D, Wide<F>> arm_a = rotate(a.rotation, anchor_a), arm_b = rotate(b.rotation, anchor_b);
            const Wrench<D, F>& kept = rows[k].wrench;  // of the step before: see `Load::load`
            rows[k].total = {-kept.force, -kept.on_a, -kept.on_b};
            rows[k].anchors = {rounded(arm_a), rounded(arm_b),
                               rounded(Vec<D, Wide<F>>((b.position - a.position) + (arm_b - arm_a)))};
        }
    }
    template <Layout L>
    static constexpr auto placing() -> void (*)(const JointSpan&, const JointSites<D>&) {
        if constexpr (has_anchors_alone(L)) return place<L>;
        return nullptr;
    }

    template <Layout L>
    static void start(const JointSpan& span, const RecordView<D>& bodies) {
        using Rows = JointRows<D, F, L>;
        each_block<Rows, false>(
            span, bodies, [](Rows& rows, Body<D, F>& a, Body<D, F>& b) CAROM_INLINE_LAMBDA {
                Link<D, F>{a.motion, b.motion, a.weight, b.weight, rows.wrench}.add(rows.wrench);
            });
    }

    template <bool biased, Layout L>
    static void solve(const JointSpan& span, const RecordView<D>& bodies, const JointStep<float>& s) {
        using Rows = JointRows<D, F, L>;
        const JointStep<F> step{F(s.h), F(s.inverse_h), F(s.share), F(s.most_way), s.again};
        each_block<Rows, biased>(
            span, bodies, [&](Rows& rows, Body<D, F>& a, Body<D, F>& b) CAROM_INLINE_LAMBDA {
                JointPass<biased, D, F, L>(rows, a.motion, b.motion, a.weight, b.weight, step).run();
            });
    }

    template <std::size_t... i>
    static constexpr JointPrograms<D> make(std::index_sequence<i...>) {
        return {width,
                {JointProgram<D>{placing<layouts<D>[i]>(), start<layouts<D>[i]>, solve<true, layouts<D>[i]>,
                                 solve<false, layouts<D>[i]>}...}};
    }
    static constexpr JointPrograms<D> all = make(std::make_index_sequence<layouts<D>.size()>());
};

}  // namespace carom::detail
