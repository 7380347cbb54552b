// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"
#include "common/rim/axis.hpp"
#include "stage3_nonlinear/model/contact_rims.hpp"
#include "stage3_nonlinear/model/spring_waves.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Side of a hole that bears, by its name in files; none for other texts, such as "" for edges.
[[nodiscard]] std::optional<rim::SignedAxis> bearing_side(const std::string& name);

/// The matrices of a plate at one degree.
struct PlateDegree {
  int degree = 0;
  MatrixXd S;  ///< (m+e+k, m+e+k), force / length
  MatrixXd R;  ///< (m+e+k, h + s) by friction cases, then by the shears of rims of contact, length^2
  MatrixXd T;  ///< (m+e+k, q), dimensionless
  MatrixXd C;  ///< (q, q) C_t, length / force
};

/// A plate at one degree p. Its unknowns u are the displacements of its m discs, hole after hole, those of its e rigid
/// externals, and the k contact moments of the rims with compression-only springs (CompressionOnlyRim).
///
/// The external forces in equilibrium with them are S u + R Lambda + T f (docs/theory.md, section 4). S does not hold
/// the springs of a rim of contact: the force that they transmit is minus the force on its moments.
///
/// What its file says beside the matrices is as it stands there, `cracks` at the joint's degree alone.
struct PlateModel : formats::PlateProperties, PlateDegree {
  std::string name, file;
  std::string materials;                          ///< JSON text of them in its PLATE.json; empty if unknown
  std::vector<std::string> holes;                 ///< (m / a)
  std::vector<int> axes;                          ///< (a) directions of each hole's discs in order: 0 x, 1 y
  std::vector<Index> discs;                       ///< of m, those in the file: symmetry fixes the others
  std::vector<bool> on_springs;                   ///< (m / a) the plate's own bearing is in S
  std::vector<int> external_axis, traction_axis;  ///< (e), (q) 0 x, 1 y; any of a moment
  std::vector<int> unsupported_axes;              ///< axes along which no support of stage 1 reacts
  /// Lower degrees, ascending, whose sequence shows the error of S; R at the last alone.
  std::vector<PlateDegree> lower;
  /// (m+e+k, m+e+k) from the file; empty if it has none that is finite, or p is not its highest degree.
  MatrixXd S_error;
  std::optional<int> stress_level;  ///< of the stresses at the joint's degree, if there are any
  std::vector<std::shared_ptr<const ContactWaves>> contact_waves{};  ///< (g) the waves of higher order, in closed form
  std::vector<std::shared_ptr<const SpringWaves>> spring_waves{};    ///< of each of `waves`, if it has stresses
  std::vector<MatrixXd> wave_rows{};  ///< PlateCases::W of all rims at the joint's degree and the one before
  bool bends = false;                 ///< secondary bending of the joint is computed
  bool peaks_alone = false;           ///< no errors of hoop stresses and no check of friction against the slip

  /// True if the peaks of hoop stresses have error bars.
  [[nodiscard]] bool has_peak_errors() const { return stress_level && !peaks_alone; }
  /// True if a traction is a moment.
  [[nodiscard]] bool is_moment(Index traction) const {
    return traction < std::ssize(traction_arm) && traction_arm[traction] > 0;
  }
  /// Sign of the force under which a traction's side of its hole bears; 0 for edges.
  [[nodiscard]] int bearing_sign(Index traction) const {
    const auto side = traction < std::ssize(traction_bearing) ? bearing_side(traction_bearing[traction]) : std::nullopt;
    return side ? side->sign : 0;
  }
  /// True if a traction case is the other side of the hole of the case before.
  [[nodiscard]] bool is_other_side(Index traction) const {
    return traction > 0 && traction < n_tractions() && traction_id[traction] == traction_id[traction - 1];
  }
  /// m: unknowns of the discs, those of the file and those that symmetry fixes.
  [[nodiscard]] Index n_disc_unknowns() const { return holes.size() * axes.size(); }
  /// True if nothing holds the sheet, whose loads must be in balance.
  [[nodiscard]] bool is_free_body() const { return held_at.size() > 0; }
  /// Force along x and y and moment about the place where a free body is held, of a unit of one of its tractions.
  [[nodiscard]] Eigen::Vector3d resultant(Index traction) const {
    Eigen::Vector3d all(0, 0, traction_moment[traction]);
    if (is_moment(traction)) return all;
    all[traction_axis[traction]] = 1;
    all[1 - traction_axis[traction]] = traction_resultant_across[traction];
    return all;
  }
  /// Stiffness of the stiffest disc or external, force / length; 0 if there is none.
  [[nodiscard]] double stiffest() const { return S.size() > 0 ? S.diagonal().maxCoeff() : 0; }
  /// True if the hoop stress around a hole is known, which it is not where a crack or another boundary cuts its rim.
  [[nodiscard]] bool has_peak(const std::string& hole) const {
    const auto is = [&](const formats::WaveRim& rim) { return rim.hole == hole && rim.has_closed_form(); };
    return std::ranges::any_of(waves, is);
  }
  /// Hole of a disc unknown.
  [[nodiscard]] const std::string& hole_of(Index disc) const { return holes[disc / axes.size()]; }
  [[nodiscard]] int axis_of(Index disc) const { return axes[disc % axes.size()]; }
  [[nodiscard]] Index n_unknowns() const { return S.rows(); }
  /// True if a hole has compression-only springs.
  [[nodiscard]] bool is_in_contact(const std::string& hole) const {
    return std::ranges::find(contact, hole, &formats::ContactRim::hole) != contact.end();
  }
  /// False if a line of symmetry fixes this displacement of the hole's disc.
  [[nodiscard]] bool has_disc(Index disc) const { return std::ranges::binary_search(discs, disc); }
  /// Column of R of the first shear of a rim of contact.
  [[nodiscard]] Index first_shear(const formats::ContactRim& rim) const {
    Index first = n_friction_cases();
    for (Index before = 0; before < &rim - contact.data(); ++before) first += waves[before].waves.n_shears();
    return first;
  }
  /// First unknown of the moments of contact.
  [[nodiscard]] Index first_moment() const { return n_disc_unknowns() + n_externals(); }
};

/// The matrices at degree p, checked: names are unique, S is symmetric and positive semi-definite. Throws FileError or
/// InputError with the file and the dataset.
/// @param axes Those of the joint; the file's own if empty.
[[nodiscard]] PlateModel make_plate(const std::string& name, const std::string& file, formats::PlateMatrices matrices,
                                    int p, const std::vector<int>& axes = {});

/// Entry i of a list; an empty list stands for zeros.
[[nodiscard]] inline double entry_or_0(const VectorXd& list, Index i) { return list.size() == 0 ? 0 : list[i]; }

/// Directions of the discs of all files, in the order of the first hole that has both, else x before y; 0 x, 1 y.
/// Throws FileError for a word that is no direction.
[[nodiscard]] std::vector<int> joint_axes(std::span<const std::string> files, std::span<const formats::UnitCases> all);

}  // namespace fastjoint::stage3
