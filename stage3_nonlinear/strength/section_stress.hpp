// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "common/formats/plate_matrices.hpp"

namespace fastjoint::stage3 {

/// A principal value of a plane stress and its direction, degrees counter-clockwise from x, above -90 up to 90.
struct Principal {
  double value = 0, direction = 0;
};

/// Mean stress xx, yy, xy over the sections around a hole; infinite where no section tells it.
using MeanStress = Eigen::Vector3d;

/// The principal value of the larger magnitude; of equal ones that in tension. Infinite if a part of the stress is.
[[nodiscard]] Principal larger_principal(const MeanStress& stress);
/// The principal value that is larger with its sign: the tension.
[[nodiscard]] Principal largest_tension(const MeanStress& stress);

/// Forces over all sections of a plate in one state, force.
struct SectionForces {
  Eigen::VectorXd normal, shear;  ///< tension positive; as the stress xy
};

/// Distance from a point along a direction to the nearest piece of a border; infinite if there is none.
/// @param held_too Pieces with supports or loads count too, beyond which the sheet may go on.
[[nodiscard]] double distance_to_border(const formats::Border& border, const Eigen::Vector2d& from,
                                        const Eigen::Vector2d& direction, bool held_too = false);

/// The sections on the sides of one hole, and what their forces say of the sheet there (docs/theory.md, section 11.6).
/// Nothing here knows along which axis a load acts: both axes are treated alike.
class HoleSections {
 public:
  /// @param rim    Index of the hole in a.rim_hole.
  /// @param border Of the sheet, by which a section is told that ends at cell lines amid the sheet; may be null.
  HoleSections(const formats::PlateStresses& a, Eigen::Index rim, const formats::Border* border = nullptr);

  [[nodiscard]] int number() const;
  /// Gross and net area of the section across an axis with the smaller net area; 0 without one, length^2.
  [[nodiscard]] double gross_area(int axis) const;
  [[nodiscard]] double net_area(int axis) const;
  /// Gross area across a direction, degrees: between those across the axes.
  [[nodiscard]] double gross_area_across(double direction) const;
  /// Net over gross area across a direction.
  [[nodiscard]] double net_share(double direction) const;
  /// True if the hole fills more than half of a section that ends amid the sheet: the force over such a strip is less
  /// than what flows around the hole, and the stress over what is left of it is none of the sheet's.
  [[nodiscard]] bool is_filled() const { return is_filled_[0] || is_filled_[1]; }

  /// True if cracks leave nothing of a section.
  [[nodiscard]] bool is_open() const { return is_open(0) || is_open(1); }

  /// Stress that passes the fastener by: without what the fastener adds on the side where it bears.
  /// @param T     Force of the fastener on the sheet, friction included.
  /// @param scale Largest force on the plate: below 1e-3 of it, or of T, a component bears on neither side.
  [[nodiscard]] MeanStress bypass(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const;
  /// Stress of the more loaded section across each axis, by magnitude, fastener included.
  [[nodiscard]] MeanStress gross(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const;
  /// The same of the net sections, of that in larger tension; infinite if the hole fills a strip that carries, or
  /// cracks have opened the section.
  [[nodiscard]] MeanStress net(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const;

 private:
  using Sides = std::array<std::optional<Eigen::Index>, 2>;  ///< on the side of + and of -
  [[nodiscard]] std::optional<Eigen::Index> smaller(int axis) const;
  [[nodiscard]] bool is_open(int axis) const { return smaller(axis) && net_area(axis) == 0; }
  /// Area across a direction by those across x and y, of which one may be missing.
  [[nodiscard]] static double across(double x, double y, double direction);
  /// The force T along an axis without sections is not seen: there the stress is not known.
  [[nodiscard]] bool is_unknown(int axis, const Eigen::Vector2d& T, double scale) const;
  /// Mean shear stress of the sections across x or across y, whichever is larger; what the fastener adds cancels.
  [[nodiscard]] double shear(const SectionForces& forces) const;

  const formats::PlateStresses& a_;
  std::array<Sides, 2> at_;          ///< by axis
  std::array<bool, 2> is_filled_{};  ///< by axis
  bool on_symmetry_;                 ///< the sheet goes on beyond the hole, as its mirror image
};

}  // namespace fastjoint::stage3
