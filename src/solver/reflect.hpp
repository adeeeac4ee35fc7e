#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/rows.hpp"

/// What several blows at one moment do together.
namespace carom::detail {

/// A body at the moment of an impact. One that cannot be pushed has no weight (zero is infinite mass).
template <int D>
struct ImpactBody {
    Motion<D, double> motion;
    Weight<D, double> weight;
};

/// A point at which two bodies, given by their indices, approach each other.
template <int D>
struct ImpactPoint {
    std::uint32_t a = 0, b = 0;
    Vec<D> normal{}, arm_a{}, arm_b{};  ///< as in `ContactRows`
    std::array<Vec<D>, D - 1> tangents{};
    std::array<double, D - 1> surface_speed{};
    double restitution = 0, friction = 0;
    double impulse = 0;                      ///< result: along the normal, on b, N·s
    std::array<double, D - 1> tangential{};  ///< result: along the tangents
};

/// Reflects the velocities at all these points at once, and lets friction act. It keeps its working space.
///
/// Let J be the rows that make speeds of separation of the velocities v, M the masses, A = J M⁻¹ Jᵀ and
/// b = J v < 0. The impulses λ with 0 ≤ λ ⟂ Aλ + b ≥ 0 (a linear complementarity problem) bring v to
/// v* = v + M⁻¹Jᵀλ: of all velocities at which nobody approaches the nearest one, in the norm of the kinetic
/// energy. This is the blow without restitution. Twice as much, v' = v + 2 M⁻¹Jᵀλ, is the mirror image of v
/// behind the face of that cone, and has the same energy, as λ · Jv* = 0: the elastic blow (B. Smith,
/// D. Kaufman, E. Vouga, R. Tamstorf, E. Grinspun, "Reflections on Simultaneous Impact", 2012). In between,
/// each point has (1 + e) λ, with its own e; then
///
///     E' − E = −½ λᵀ (A − e A e) λ
///
/// with e as a diagonal matrix. That is a loss where all e are equal; where they are not it may be a gain,
/// and then all e are made smaller by the same factor, until it is none.
///
/// Friction takes as much energy as it can with impulses |β| ≤ μ (1 + e) λ at each point (Coulomb).
///
/// Points of bodies that share nothing are solved apart.
template <int D>
class Reflection {
  public:
    void reflect(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points);

  private:
    void find_groups(std::span<const ImpactBody<D>> bodies, std::span<const ImpactPoint<D>> points);
    void solve_normals(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points,
                       std::span<const std::uint32_t> group);
    void solve_friction(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points,
                        std::span<const std::uint32_t> group);
    void sweep_normals(std::span<ImpactBody<D>> bodies, std::span<const ImpactPoint<D>> points,
                       std::span<const std::uint32_t> group);

    std::vector<std::uint32_t> leader_, order_;  ///< by body: a body of the same group; points by group
    std::vector<double> matrix_, speed_, push_;
};

/// Solves 0 ≤ x ⟂ A x + b ≥ 0 for a symmetric, positive semi-definite matrix, row by row, of b.size() rows.
/// The result does not depend on the order of the rows, but for rounding: where A is singular, it is the
/// shortest.
void solve_complementarity(std::span<const double> matrix, std::span<const double> b, std::span<double> x);

}  // namespace carom::detail
