#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/joint_input.hpp"

namespace carom::detail {

/// Which joints are solved directly, and which of them hang together: by bodies that can be pushed.
template <int D>
class JointGroups {
  public:
    /// Looks at the joints of a step. Returns whether those that are solved directly, or their bodies, are
    /// others than before.
    bool plan(const JointInput<D>& input);

    std::span<const std::uint32_t> iterative() const { return iterative_; }
    /// One group after the other; where each begins.
    std::span<const std::uint32_t> direct() const { return direct_; }
    std::span<const std::uint32_t> starts() const { return starts_; }

  private:
    /// All that the answer depends on.
    struct Tie {
        std::uint32_t joint = 0, layout = 0, a = 0, b = 0;
        double mass_a = 0, mass_b = 0;  ///< inverse
        bool is_limited = false;
        friend bool operator==(const Tie&, const Tie&) = default;
    };

    /// A body of a group, and what hangs on the joint by which it is reached, itself included.
    struct Hanging {
        std::uint32_t slot = 0;
        double mass = 0, load = 0;
        Hanging* from = nullptr;
        bool reached = false;
    };

    bool look(const JointInput<D>& input);
    void group(const JointInput<D>& input);
    std::uint32_t root(std::uint32_t tie);
    bool is_hard(std::span<const std::uint32_t> group);
    double greatest_load(std::span<const std::uint32_t> group, bool some_still);

    JointMethod method_ = JointMethod::iterative;
    std::uint32_t first_movable_ = 0;
    std::vector<Tie> ties_, seen_;
    std::vector<std::uint32_t> parent_;  ///< by tie: of the forest of those that hang together
    std::vector<Hanging> bodies_;
    std::vector<std::uint32_t> iterative_, direct_, starts_;
};

}  // namespace carom::detail
