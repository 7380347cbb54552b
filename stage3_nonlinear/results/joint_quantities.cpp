// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_quantities.hpp"

#include <utility>

#include "stage3_nonlinear/results/bending.hpp"
#include "stage3_nonlinear/results/contact_quantities.hpp"
#include "stage3_nonlinear/results/crack_quantities.hpp"
#include "stage3_nonlinear/results/hole_quantities.hpp"
#include "stage3_nonlinear/results/row_forces.hpp"

namespace fastjoint::stage3 {
namespace {

using columns::Of;

/// Two lists as one in which their numbers alternate.
VectorXd alternating(const VectorXd& a, const VectorXd& b) {
  VectorXd all(2 * a.size());
  for (Index i = 0; i < a.size(); ++i) all.segment<2>(2 * i) << a[i], b[i];
  return all;
}

/// Displacements of a plate's discs and externals, the forces on them, and their resultants.
std::vector<PlateGroup> displacement_quantities(const PlateModel& plate) {
  using columns::force, columns::length;
  const Index e = plate.n_externals(), q = plate.n_tractions(), h = plate.n_friction_cases();
  Index n_added = 0, n_w = 0;
  for (Index i = 0; i < std::ssize(plate.contact); ++i) {
    const rim::Harmonics of_field = formats::waves_of_field(plate.contact[i], plate.waves[i]);
    n_added += of_field.size() + of_field.n_shears();
    n_w += of_field.size();
  }
  return {
      PlateGroup(Of::external, e,
                 {formats::De, {"Pe", force, "force on each external", "external_force"}, formats::free_De},
                 [](const PlateAt& at) {
                   const VectorXd& free = at.free().De;
                   return side_by_side({at.state().De + free, at.state().Pe, free});
                 }),
      PlateGroup(Of::disc, std::ssize(plate.discs),
                 {formats::D,
                  formats::free_D,
                  {"disc/bearing", force, "bearing force of the fastener on each disc"},
                  {"disc/friction", force, "resultant of its friction along each disc"}},
                 [](const PlateAt& at) {
                   const auto& state = at.state();
                   const VectorXd& free = at.free().D;
                   return MatrixXd(side_by_side({state.D + free, free, state.bearing, state.friction})(at.model().discs,
                                                                                                       Eigen::all));
                 }),
      PlateGroup(Of::traction, q,
                 {formats::traction_force,
                  {"traction/displacement", length,
                   "mean displacement of each traction boundary along its direction, of a moment rotation times arm",
                   "", h5::infinite_too}},
                 [](const PlateAt& at) {
                   return side_by_side({at.state().traction, at.state().traction_displacement + at.free().traction});
                 }),
      PlateGroup(Of::friction_case, h, {formats::Lambda}, [h](const PlateAt& at) { return at.state().Lambda.head(h); }),
      PlateGroup(Of::wave, n_added, {formats::wave_amount}, [](const PlateAt& at) { return at.state().added; }),
      PlateGroup(
          Of::wave, n_w,
          {{"contact/w", length,
            "mean over the rim of the disc's normal displacement relative to the sheet times each distribution of "
            "pressure, rim after rim"}},
          [](const PlateAt& at) { return at.state().w; }),
      PlateGroup(Of::axis, 2,
                 {{"total/applied", force, "force of externals along x and y"},
                  {"total/by_fasteners", force, "force of the fasteners along x and y"},
                  {"total/by_supports", force,
                   "minus the sum of these: the reaction of supports, or where there are none what is out of balance"}},
                 [](const PlateAt& at) {
                   return side_by_side({at.state().applied, at.state().by_fasteners, at.state().by_supports});
                 })};
}

}  // namespace

std::vector<JointGroup> plane_quantities(const JointModel& joint) {
  using columns::force, columns::length;
  const Index n = joint.n_planes(), a = joint.n_directions();
  std::vector<std::string> directions;
  for (Index d = 0; d < a; ++d) directions.emplace_back(joint.axis_name(d));
  const columns::Output loads{"force", "forces", "load that each fastener transfers", "largest transferred load of all",
                              true};
  return {
      JointGroup(Of::plane, n,
                 {{"transferred",
                   force,
                   "bearing and friction together, on the first and on the second plate",
                   "transferred",
                   {},
                   loads}},
                 [](const JointAt& at) { return alternating(at.state.transferred_first, at.state.transferred_second); },
                 {{"first", "second"}}),
      JointGroup(Of::plane, n,
                 {{"F", force, "force of the fastener's law: of bearing, or transferred if it includes friction", "F"}},
                 [a](const JointAt& at) { return magnitudes(at.step.F, a); }),
      JointGroup(
          Of::plane, n, {{"F_vector", force, "components of F", a > 1 ? "F" : ""}},
          [](const JointAt& at) { return at.step.F; }, directions),
      JointGroup(Of::plane, n,
                 {{"delta", length, "displacement of the first plate's disc relative to the second's", "delta"}},
                 [a](const JointAt& at) { return magnitudes(at.step.delta, a); }),
      JointGroup(
          Of::plane, n, {{"delta_vector", length, "components of delta"}},
          [](const JointAt& at) { return at.step.delta; }, directions)};
}

std::vector<JointGroup> memory_quantities(const JointModel& joint, const JointEquations& equations) {
  using columns::length;
  if (!equations.remembers()) return {};
  const Index n = joint.n_planes(), a = joint.n_directions();
  return {JointGroup(
              Of::plane, n,
              {{"memory/set", length,
                "permanent set of each plane: the part of delta that yield or slip in bearing has left"}},
              [n, a](const JointAt& at) {
                VectorXd set(n * a);
                for (Index j = 0; j < n; ++j) set.segment(j * a, a) = at.step.memories[j].set;
                return set;
              },
              std::vector<std::string>(a)),
          JointGroup(Of::plane, n,
                     {{"memory/dissipated", columns::energy,
                       "energy that slip and yield of each plane have taken since the joint was unloaded"}},
                     [n](const JointAt& at) {
                       return VectorXd::NullaryExpr(n, [&](Index j) { return at.step.memories[j].dissipated; });
                     })};
}

std::vector<PlateGroup> plate_quantities(const PlateModel& plate) {
  std::vector<PlateGroup> groups{hole_quantities(plate), contact_quantities(plate)};
  for (auto& group : displacement_quantities(plate)) groups.push_back(std::move(group));
  groups.push_back(crack_quantities(plate));
  groups.push_back(row_quantities(disc_rows(plate)));
  for (auto& group : bending_quantities(plate)) groups.push_back(std::move(group));
  return groups;
}

formats::PlateHistory things_of(const PlateModel& plate) {
  formats::PlateHistory a;
  a.name = plate.name;
  a.materials = plate.materials;
  a.matrices_digest = plate.header.digest;
  a.plate_digest = plate.plate_digest;
  static_cast<formats::UnitCases&>(a) = plate;
  a.traction_bearing.resize(plate.traction_id.size());
  a.traction_arm.resize(plate.traction_id.size());
  a.waves.resize(a.contact.size());  // of the rims in contact alone
  for (std::size_t i = 0; i < a.waves.size(); ++i) a.waves[i].waves = formats::waves_of_field(a.contact[i], a.waves[i]);
  a.tips = plate.cracks.tips;
  if (plate.stress_level) a.holes = holes_of(plate.stresses);
  a.rows = row_list(disc_rows(plate));
  return a;
}

}  // namespace fastjoint::stage3
