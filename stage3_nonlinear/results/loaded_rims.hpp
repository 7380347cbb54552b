// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/interfaces/rim_contact.hpp"
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
  // In contact: tractions and their kinks by the joint's waves alone.
  Tractions by_joints_waves{};
  std::vector<double> kinks_by_joints_waves{};

  /// Places one degree apart around the rim, or from end to end of a part of one in equal steps of about that, degrees.
  [[nodiscard]] VectorXd places() const;
  /// Stresses of the sheet at places in degrees: sigma_rr, sigma_tt, sigma_rt, (n, 3).
  [[nodiscard]] MatrixXd stresses(const VectorXd& places) const;
  [[nodiscard]] std::shared_ptr<const TractionWaves> traction_waves(const Tractions& tractions) const;
  /// Hoop stress by the displacements of one degree up to an order.
  [[nodiscard]] HoopStress hoop(Index degree, const rim::Harmonics& shape,
                                std::shared_ptr<const TractionWaves> tractions) const;
};

/// What the rims of contact of a plate bear, each from the moments of its displacement.
struct ContactLoad {
  VectorXd moments;   ///< waves of the disc's normal displacement against the sheet, length
  VectorXd pressure;  ///< waves of the pressure on the sheet, stress
  VectorXd shear;     ///< waves of the shear on it, stress; 0 without friction
  double gap;
  /// The moments, and behind them those of the waves up to twice the order, which the joint leaves out: they follow
  /// from the pressure in closed form. `shape` is theirs.
  struct Contour {
    rim::Harmonics shape;
    VectorXd w;                ///< length
    double mu;                 ///< shear over pressure; less than the fastener's where the rim sticks
    double direction;          ///< of the force of the pressure on the sheet, radians
    std::vector<double> ends;  ///< of the arcs on which they touch, radians
  };
  Contour joints, wider;  ///< of the joint's waves, and of more
};
/// @param rim With the moments' stiffness, gap and friction.
[[nodiscard]] ContactLoad contact_load(const RimContact& rim, const ShortWaves& waves, double area,
                                       const VectorXd& moments, const VectorXd& shear);

/// Amounts of the waves that the elements carry under a load of contact: of pressures those that are added to what the
/// springs of the base bear, then of shears, (n_carried), stress.
[[nodiscard]] VectorXd wave_amounts(const ContactLoad& load, const ShortWaves& rim, double modulus);

/// Rims of a plate with waves and a closed form, in the order of PlateModel::waves; none where there is no closed form.
/// @param amounts  Of the file's unit cases, (file_unit_cases).
/// @param contacts Of the rims of contact.
[[nodiscard]] std::vector<std::optional<LoadedRim>> loaded_rims(const PlateModel& plate, const VectorXd& amounts,
                                                                const std::vector<ContactLoad>& contacts);

}  // namespace fastjoint::stage3
