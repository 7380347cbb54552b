// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "common/infinite.hpp"
#include "stage3_nonlinear/interfaces/rim_problem.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/results/hoop_stress.hpp"

namespace fastjoint::stage3 {

/// Long waves of the displacement of a rim, and the tractions on it, at one degree.
struct RimWaves {
  VectorXd displacement;  ///< of the disc relative to the sheet: normal, then tangential, (size + n_shears), length
  Tractions tractions;
};

/// A rim in one state.
struct LoadedRim {
  formats::WaveRim rim;
  std::vector<RimWaves> degrees;  ///< the joint's, then the one below if there is one
  bool in_contact;
  std::vector<double> kinks;  ///< angles at which tractions have kinks or jumps, radians
  // Only in contact: tractions and their kinks by fewer waves.
  Tractions by_fewer{};
  std::vector<double> kinks_by_fewer{};
  /// Estimated change of the peak by all further waves over that from the fewer waves. It falls as N^-3/2 or faster;
  /// with friction on an elastic disk the stress is like a square root at the end of contact, and it falls as N^-1/2.
  /// Infinite if there are no fewer waves.
  double beyond = 0;
  bool has_root_at_end = false;  ///< the peak falls so as N^-1/2, and is extrapolated
  VectorXd slip{};        ///< all waves of the tangential displacement of the disc relative to the sheet, length; none
                          ///< without friction and of a rim that sticks
  rim::Harmonics all{1};  ///< its shears are the waves of `slip`

  /// Angle on which friction acts against the slip, degrees of the whole hole, of which the rim may be a half; 0 of a
  /// rim that sticks.
  [[nodiscard]] double against_slip() const;

  /// Angles one degree apart around the rim, or in about such steps from end to end of a part of a rim, degrees.
  [[nodiscard]] VectorXd places() const;
  /// Stresses of the sheet at angles in degrees: sigma_rr, sigma_tt, sigma_rt, (n, 3).
  [[nodiscard]] MatrixXd stresses(const VectorXd& places) const;
  [[nodiscard]] std::shared_ptr<const TractionWaves> traction_waves(const Tractions& tractions) const;
  /// Hoop stress from the displacements of one degree up to an order.
  [[nodiscard]] HoopStress hoop(Index degree, const rim::Harmonics& shape,
                                std::shared_ptr<const TractionWaves> tractions) const;
};

/// Displacement and tractions of a rim of contact.
struct ContactLoad {
  /// Tractions as waves and, from the waves of the displacement, as functions of the angle.
  struct Contour {
    std::shared_ptr<const ShortWaves> waves;
    VectorXd pressure;                  ///< (n) waves of the pressure on the sheet, stress
    VectorXd shear;                     ///< (n_shears) waves of the shear on it, stress; 0 without friction
    VectorXd w;                         ///< without the compliance of the disk or the springs, length
    double mu;                          ///< shear over pressure; less than that of the fastener if the rim sticks
    double modulus;                     ///< pressure per unit of overlap of the rims, force / length^3
    double direction;                   ///< of the resultant of the pressure on the sheet, radians
    std::vector<rim::AngleRange> arcs;  ///< of contact
    bool slips;                         ///< else the rim sticks, and where it does so is not known
  };
  VectorXd w;                         ///< (n) all waves of the disc's normal displacement relative to the sheet, length
  double gap;                         ///< radial, length
  Contour own;                        ///< from the waves with which the joint is solved
  std::optional<Contour> compared{};  ///< from another number of waves, to estimate the effect of further ones

  [[nodiscard]] bool compares_with_more() const { return compared && compared->waves->n > own.waves->n; }
  [[nodiscard]] const Contour& finest() const { return compares_with_more() ? *compared : own; }
};
[[nodiscard]] ContactLoad contact_load(const RimProblem& rim, const RimSolution& solution);
/// Contact of a rim with the coordinates c. @param compares Whether it has ContactLoad::compared, if the rim has waves
/// to compare with.
[[nodiscard]] ContactLoad contact_load(const RimProblem& rim, const VectorXd& c, bool compares);

/// Coefficients of the waves of the elements under a contact load: pressures in excess of that of the springs in S,
/// then shears, (n_carried), stress.
[[nodiscard]] VectorXd wave_coefficients(const ContactLoad& load, double modulus);

/// Rims of a plate in the order of PlateModel::waves; none for rims without a closed form.
/// @param coefficients  Of the file's unit cases, (n_cases).
/// @param contacts One for each rim of contact.
[[nodiscard]] std::vector<std::optional<LoadedRim>> loaded_rims(const PlateModel& plate, const VectorXd& coefficients,
                                                                const std::vector<ContactLoad>& contacts);

}  // namespace fastjoint::stage3
