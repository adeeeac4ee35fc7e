#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/joint_input.hpp"

namespace carom::detail {

/// Pulleys, gears and racks in the sub-steps of the solver: rows between up to four bodies. There are few of
/// them, so they are solved one by one.
template <int D>
class Couplings {
  public:
    /// Takes up the couplings of bodies that move.
    void plan(const JointInput<D>& input) { rows_.resize(input.active_couplings.size()); }
    bool any() const { return !rows_.empty(); }
    /// Fills the rows and applies the impulses that they have kept.
    void prepare(const JointInput<D>& input);
    void solve(const RecordView<D>& bodies) { pass<true>(bodies); }
    void relax(const RecordView<D>& bodies) { pass<false>(bodies); }
    void store(const JointInput<D>& input) const;

  private:
    struct End {
        DriveKind kind = DriveKind::turn;
        std::uint32_t a = 0, b = 0;
        Anchors<D, float> anchors{};
        Vec<D, float> axis{};
        float factor = 0;
    };
    /// What a unit of impulse does to a body.
    struct Effect {
        std::uint32_t slot = 0;
        Vec<D, float> push{};
        Angular<D, float> twist{};
    };
    struct Row {
        std::uint32_t coupling = 0;
        std::array<End, 2> ends;
        float error = 0;  ///< at the start of the step
        bool is_rope = false;
        float impulse = 0, before = 0, total = 0;  ///< of this sub-step, of the one before, of the step
        std::array<Effect, 4> effects{};
        Wrench<D, float> on_last{};  ///< of a unit of impulse, of the second end
    };
    /// A row as it is in the middle of a pass.
    struct View {
        std::array<Effect, 4> effects{};
        int count = 0;
        float speed = 0, error = 0;
        Wrench<D, float> on_last{};
    };

    template <bool biased>
    void pass(const RecordView<D>& bodies);
    template <bool biased>
    View look_at(const Row& row, const RecordView<D>& bodies) const;
    template <bool biased>
    float look_at_end(const End& end, const RecordView<D>& bodies, View& view) const;
    static void add(View& view, const Effect& effect);
    static float compliance(const View& view, const RecordView<D>& bodies);
    static void push(std::span<const Effect> effects, const RecordView<D>& bodies, float impulse);
    static void shift(const View& view, const RecordView<D>& bodies, float impulse);

    JointStep<float> step_{};
    std::vector<Row> rows_;
};

}  // namespace carom::detail
