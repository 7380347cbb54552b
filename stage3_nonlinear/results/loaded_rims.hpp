// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/interfaces/rim_problem.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"
#include "stage3_nonlinear/results/hoop_stress.hpp"

namespace fastjoint::stage3 {

/// Displacements of a rim in its long waves and the tractions on it, of one degree.
struct RimWaves {
  VectorXd displacement;  ///< of the disc against the sheet, normal, then tangential, (size + n_shears), length
  Tractions tractions;
};

/// A rim in one state.
struct LoadedRim {
  formats::WaveRim rim;
  std::vector<RimWaves> degrees;  ///< the joint's, then the one below if there is one
  bool in_contact;
  std::vector<double> kinks;  ///< places where tractions have kinks or jumps, radians
  // In contact: tractions and their kinks by waves of half the order.
  Tractions by_half{};
  std::vector<double> kinks_by_half{};
  /// What waves beyond the last may change the peak by, over what the upper half of them does: with friction on an
  /// elastic disk the peak is that of a root at the end of contact, and comes as N^-1/2.
  double beyond_half = 0.5;
  VectorXd
      slip{};  ///< all waves of the disc's displacement along the rim against the sheet, length; none without friction
  rim::Harmonics all{1};  ///< of which it has the shears

  /// Part of the rim on which friction acts against the slip, degrees.
  [[nodiscard]] double against_slip() const;

  /// Places one degree apart around the rim, or from end to end of a part of one in equal steps of about that, degrees.
  [[nodiscard]] VectorXd places() const;
  /// Stresses of the sheet at places in degrees: sigma_rr, sigma_tt, sigma_rt, (n, 3).
  [[nodiscard]] MatrixXd stresses(const VectorXd& places) const;
  [[nodiscard]] std::shared_ptr<const TractionWaves> traction_waves(const Tractions& tractions) const;
  /// Hoop stress by the displacements of one degree up to an order.
  [[nodiscard]] HoopStress hoop(Index degree, const rim::Harmonics& shape,
                                std::shared_ptr<const TractionWaves> tractions) const;
};

/// What a rim of contact of a plate bears.
struct ContactLoad {
  VectorXd w;           ///< (n) all waves of the disc's normal displacement against the sheet, length
  VectorXd pressure;    ///< (n) waves of the pressure on the sheet, stress
  VectorXd shear;       ///< waves of the shear on it, stress; 0 without friction
  double gap, modulus;  ///< radial, length; pressure per overlap of the rims, force / length^3
  /// The tractions as functions of the angle, by waves of the displacement up to an order, which is that of `shape`.
  struct Contour {
    rim::Harmonics shape;
    VectorXd w;                ///< without what an elastic disk yields, length
    double mu;                 ///< shear over pressure; less than the fastener's where the rim sticks
    double direction;          ///< of the force of the pressure on the sheet, radians
    std::vector<double> ends;  ///< of the arcs on which they touch, radians
  };
  Contour all, half;  ///< by all waves, and by those of half the order, to tell what those beyond may do
};
/// @param w Waves of the displacement, (n), length.
[[nodiscard]] ContactLoad contact_load(const RimProblem& rim, const VectorXd& w);

/// Amounts of the waves that the elements carry under a load of contact: of pressures those that are added to what the
/// springs of the base bear, then of shears, (n_carried), stress.
[[nodiscard]] VectorXd wave_amounts(const ContactLoad& load, const ShortWaves& rim, double modulus);

/// Rims of a plate with waves and a closed form, in the order of PlateModel::waves; none where there is no closed form.
/// @param amounts  Of the file's unit cases, (file_unit_cases).
/// @param contacts Of the rims of contact.
[[nodiscard]] std::vector<std::optional<LoadedRim>> loaded_rims(const PlateModel& plate, const VectorXd& amounts,
                                                                const std::vector<ContactLoad>& contacts);

}  // namespace fastjoint::stage3
