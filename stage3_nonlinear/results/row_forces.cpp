// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/row_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/count.hpp"

namespace fastjoint::stage3 {
namespace {

/// A force along an axis that acts somewhere between two coordinates.
struct PlacedForce {
  double from, to, value;
};

constexpr double negligible_force = 1e-10;  ///< of the largest force: rounding

/// All forces on the sheet along an axis.
struct PlacedForces {
  std::vector<PlacedForce> all;
  double largest = 0;
};

PlacedForces forces_along(const PlateModel& plate, int axis, const PlateState& state) {
  PlacedForces result;
  auto& forces = result.all;
  for (Index i = 0; i < std::ssize(plate.discs); ++i) {
    const Index disc = plate.discs[i];
    const double at = plate.places.disc(i, axis);
    if (plate.axis_of(disc) == axis) forces.push_back({at, at, state.bearing[disc] + state.friction[disc]});
  }
  for (Index i = 0; i < plate.n_externals(); ++i)
    if (plate.external_axis[i] == axis)
      forces.push_back({plate.places.external(i, 0), plate.places.external(i, 1), state.Pe[i]});
  for (Index i = 0; i < plate.n_tractions(); ++i)
    if (plate.traction_axis[i] == axis && !plate.is_moment(i))
      forces.push_back({plate.places.traction(i, 0), plate.places.traction(i, 1), state.traction[i]});
  for (const auto& force : forces) result.largest = std::max(result.largest, std::abs(force.value));
  const double reaction = state.by_supports[axis];
  if (std::abs(reaction) > negligible_force * result.largest)  // else there is no support
    forces.push_back({plate.places.support(axis, 0), plate.places.support(axis, 1), reaction});
  return result;
}

/// Sum of the forces beyond a section, the tension in the sheet there.
double beyond(const PlacedForces& forces, double section) {
  double sum = 0;
  for (const auto& force : forces.all) {
    if (force.from < section && force.to > section && force.value != 0) return std::numeric_limits<double>::infinity();
    if (force.from >= section) sum += force.value;
  }
  return std::abs(sum) <= negligible_force * forces.largest ? 0 : sum;
}

}  // namespace

formats::RowList row_list(const std::vector<DiscRow>& rows) {
  const Index w = std::ssize(rows);
  formats::RowList list{{}, VectorXd(w), Eigen::VectorXi(w)};
  for (Index i = 0; i < w; ++i) {
    list.direction.emplace_back(rim::axis_names[rows[i].axis]);
    list.at[i] = rows[i].at;
    list.holes[i] = count_of(rows[i].discs);
  }
  return list;
}

MatrixXd row_forces(const PlateModel& plate, const std::vector<DiscRow>& rows, const PlateState& state) {
  MatrixXd all = MatrixXd::Zero(std::ssize(rows), 3);
  PlacedForces forces;
  for (Index i = 0; i < all.rows(); ++i) {
    const auto& [axis, at, discs] = rows[i];
    if (i == 0 || axis != rows[i - 1].axis) forces = forces_along(plate, axis, state);
    for (const Index disc : discs) all(i, 0) += state.bearing[disc] + state.friction[disc];
    // Rounding of the places must not put an edge at the row on its other side.
    const double margin = row_tolerance(plate, axis) + 1e-9 * std::abs(at);
    all(i, 1) = beyond(forces, at - margin);
    all(i, 2) = beyond(forces, at + margin);
  }
  return all;
}

VectorXd tensions(const PlateModel& plate, int axis, const PlateState& state, const VectorXd& at) {
  const PlacedForces forces = forces_along(plate, axis, state);
  return at.unaryExpr([&](double each) { return beyond(forces, each); });
}

PlateGroup row_quantities(std::vector<DiscRow> rows) {
  const char* section = "force in the plate over its whole section there, tension positive";
  const Index n = std::ssize(rows);
  return {columns::Of::row,
          n,
          {{"row/force", columns::force, "force of the fasteners of each row along its direction"},
           {"row/before", columns::force, section, "", h5::infinite_too},
           {"row/after", columns::force, section, "", h5::infinite_too}},
          [rows = std::move(rows)](const PlateAt& at) { return row_forces(at.model(), rows, at.state()); }};
}

}  // namespace fastjoint::stage3
