#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "solver/joint_load.hpp"
#include "solver/joint_rows.hpp"

/// The rows of a joint that is solved directly with others. They say the same as those of
/// solver/joint_parts.hpp, one joint at a time, in double precision and for any layout.
namespace carom::detail {

/// A row over the motions of two bodies.
template <int D>
struct DirectRow {
    Wrench<D, double> middle{};  ///< what a unit of impulse is on the bodies
    Wrench<D, double> end{};     ///< by which the speed that is to be is measured
    double error = 0;            ///< of position, as far as it is put right in this sub-step
    double coordinate = 0;       ///< of a drive
    double impulse = 0;          ///< in this sub-step so far
};

/// What a row asks for: speed + compliance · (impulse − given) = speed_wanted. A row that is not `open` keeps
/// its impulse, which is `given`.
struct RowLaw {
    bool open = true;
    double softness =
        0;  ///< compliance, in parts of that of the row alone (of a spring in space: of its block)
    double speed_wanted = 0;
    double given = 0;

    bool is_firm() const { return open && softness == 0; }
};

/// A coordinate that may be limited, driven and sprung, seen as one row: the speed it has after the sub-step
/// says its impulse, and the greater the speed the smaller the impulse.
struct DriveLaw {
    double low = 0, high = 0;  ///< speeds at which the limits hold
    bool two_way = false;      ///< it is held at one value
    bool has_limits = false;
    double motor_speed = 0, motor_most = 0;
    double softness = 0, spring_speed = 0, spring_most = 0;  ///< no spring where the softness is zero

    /// The piece of the law that is to be tried next, for a row that has this speed and impulse now.
    /// What bodies answer to an impulse is `compliance`, or `alone` by their masses.
    RowLaw piece_at(double speed, double impulse, double compliance, double alone) const;
    /// Without what can hold a coordinate.
    DriveLaw let_go() const;

  private:
    struct Point {
        double speed = 0;
        RowLaw law;
    };
    Point with_spring(double motor, double speed, double impulse, double slope, double alone) const;
};

/// A joint among those that are solved directly.
template <int D>
struct DirectJoint {
    static constexpr int most_rows = D == 2 ? 4 : 8;
    static constexpr int turns = D == 2 ? 1 : 3;  ///< directions about which bodies turn

    std::uint32_t joint = 0;
    std::uint32_t a = 0, b = 0;  ///< bodies, in the list of the solver
    std::uint32_t layout = 0;
    std::uint32_t first_row = 0;
    double compliance = 0;  ///< of each row, in parts of that by which the bodies give way alone

    // As at the start of the step.
    Anchors<D, double> anchors{};
    std::array<Vec<D, double>, D - 1> across{};
    Angular<D, double> turn{};
    Vec<D, double> axis_a{}, axis_b{};
    std::array<DriveBase<D, float>, most_drives> drives{};
    SpringRow<float> linear_spring{}, angular_spring{};
    double friction = 0;

    // From sub-step to sub-step.
    std::array<double, most_rows> impulses{};
    Angular<D, double> across_impulse{};  ///< of rows whose directions are chosen anew
    Angular<D, double> rubbed{};          ///< the part of friction in that of the angular rows
    std::array<double, most_rows>
        before_speed{};                      ///< at the start of the sub-step, of rows that may be sprung
    std::array<double, most_rows> offset{};  ///< what springs ask for in this sub-step
    Wrench<D, double> wrench{}, before{}, total{};  ///< as in `JointRecord`

    const Layout& rows() const { return layouts<D>[layout]; }
    int linear_rows() const;
    int angular_rows() const;
    int row_count() const { return linear_rows() + angular_rows() + rows().drive_count; }
    /// The part that a row belongs to: of the rows of a part all or none are sprung.
    int part_of(int row) const {
        if (row >= first_drive()) return 2 + row - first_drive();
        return row < linear_rows() ? 0 : 1;
    }
    const SpringRow<float>& spring_of(int part) const {
        if (part >= 2) return drives[static_cast<std::size_t>(part - 2)].spring;
        return part == 0 ? linear_spring : angular_spring;
    }
    bool is_held(int part) const {
        return part == 0 ? rows().linear == LinearPart::held : rows().angular == AngularPart::held;
    }
    bool is_sprung(int part) const { return (part >= 2 || is_held(part)) && spring_of(part).keep > 0; }
    int first_drive() const { return linear_rows() + angular_rows(); }
    bool is_rigid() const;  ///< does every row hold at all times?

    /// Takes the joint up as it is at the start of a step.
    void load(JointRecord<D>& record, std::span<const BodyState<D>> states,
              std::span<const BodyMass<D>> masses, double h);
    void store(JointRecord<D>& record) const;
    /// Takes from the rows what springs ask for in this sub-step.
    void set_offsets(std::span<const DirectRow<D>> rows);
};

constexpr int linear_rows(LinearPart part, int dimension) {
    return part == LinearPart::none ? 0 : part == LinearPart::line ? dimension - 1 : dimension;
}
constexpr int angular_rows(AngularPart part, int dimension) {
    if (part == AngularPart::none) return 0;
    if (part == AngularPart::square) return 1;
    return part == AngularPart::across ? 2 : dimension == 2 ? 1 : 3;
}

/// Where the anchors are in the middle of a sub-step.
template <int D>
struct JointArms {
    Vec<D> a{}, b{};  ///< from the centres of mass
    Vec<D> gap{};     ///< from anchor a to anchor b
};

/// Writes the rows of a joint at the start (`biased`) or the end of a sub-step. Impulses stay what they are.
template <bool biased, int D>
JointArms<D> lay_rows(const DirectJoint<D>& joint, const Motion<D, double>& a, const Motion<D, double>& b,
                      const JointStep<double>& step, std::span<DirectRow<D>> rows);

/// The law of a drive in this sub-step.
template <int D>
DriveLaw drive_law(const DirectJoint<D>& joint, int drive, double coordinate, const JointStep<double>& step);

}  // namespace carom::detail
