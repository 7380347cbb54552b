// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/free_shape.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fastjoint::stage3 {
namespace {

double temperature_of(const CaseScene& its, const std::string& plate) {
  const auto found = its.temperature.find(plate);
  return found == its.temperature.end() ? 0 : found->second;
}

[[noreturn]] void fail(const CaseScene& its, const PlateModel& plate, const std::string& found,
                       const std::string& allowed) {
  refuse(fmt::format("{}/temperatures/{}", its.where, plate.name), found, allowed);
}

/// Middle of the supports along an axis, about which the sheet expands; that of its discs without any.
double fixed_place(const CaseScene& its, const PlateModel& plate, int axis) {
  constexpr double same = 1e-9;
  const auto& places = plate.places;
  const double from = places.support_middle(axis, 0), to = places.support_middle(axis, 1);
  if (to - from > same * (std::abs(from) + std::abs(to)))
    fail(its, plate,
         fmt::format("supports hold this sheet along {} at {:g} and at {:g}, between which it cannot expand",
                     rim::axis_names[axis], from, to),
         "a sheet with supports at one place along each direction, whose expansion is free");
  const bool is_supported = places.support.row(axis).squaredNorm() > 0 || from != 0;
  return is_supported || places.disc.rows() == 0 ? from : places.disc.col(axis).mean();
}

/// Sets the free displacements of boundaries under tractions.
void expand_tractions(const PlateModel& plate, const Eigen::Matrix2d& strain, const Eigen::Vector2d& fixed,
                      FreeShape& shape) {
  for (Index i = 0; i < plate.n_tractions(); ++i) {
    const int axis = plate.traction_axis[i];
    if (!plate.is_moment(i))
      shape.traction[i] = strain(axis, axis) * (plate.places.traction.row(i).mean() - fixed[axis]);
  }
}

/// Adds the free expansion of a sheet.
void expand(const CaseScene& its, const PlateModel& plate, double temperature, FreeShape& shape) {
  if (plate.expansion.size() == 0)
    fail(its, plate, fmt::format("the expansion of {} is not known", plate.file),
         "a sheet whose materials have one \"alpha\", or \"alpha1\" and \"alpha2\"");
  if (!plate.places.is_known())
    fail(its, plate, fmt::format("the places of the discs of {} are not known", plate.file),
         "matrices of this version, or disc/center, external/range, support/range and support/middle made by hand");
  const Eigen::Vector2d fixed(fixed_place(its, plate, 0), fixed_place(its, plate, 1));
  Eigen::Matrix2d strain;
  strain << plate.expansion[0], plate.expansion[2], plate.expansion[2], plate.expansion[1];
  strain *= temperature;
  for (Index i = 0; i < std::ssize(plate.discs); ++i) {
    const Index disc = plate.discs[i];
    shape.D[disc] += strain.row(plate.axis_of(disc)).dot(plate.places.disc.row(i).transpose() - fixed);
  }
  expand_tractions(plate, strain, fixed, shape);
  for (Index i = 0; i < plate.n_externals(); ++i) {
    const int axis = plate.external_axis[i];
    shape.De[i] += strain(axis, axis) * (plate.places.external.row(i).mean() - fixed[axis]);
    const auto displaces = [&](const LoadScene& load) {
      return load.is_displacement && load.external.plate == plate.name && load.external.name == plate.external_id[i];
    };
    if (strain(0, 1) != 0 && std::ranges::any_of(its.loads, displaces))
      fail(its, plate,
           fmt::format("\"{}\" has a given displacement, and this sheet expands in shear too", plate.external_id[i]),
           "a force on it, or a sheet whose axes are x and y");
  }
}

}  // namespace

FreeShape undisplaced(const PlateModel& plate) {
  return {VectorXd::Zero(plate.n_disc_unknowns()), VectorXd::Zero(plate.n_externals()),
          VectorXd::Zero(plate.n_tractions())};
}

std::vector<FreeShape> free_shapes(const JointModel& joint, const JointScene& scene, const CaseScene& its) {
  std::vector<FreeShape> shapes;
  for (const auto& plate : joint.plates) {
    FreeShape& shape = shapes.emplace_back(undisplaced(plate));
    if (const double temperature = temperature_of(its, plate.name); temperature != 0)
      expand(its, plate, temperature, shape);
  }
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i)
    for (Index at = 0; at < std::ssize(scene.fasteners[i].offset); ++at) {
      const HoleModel& hole = joint.fasteners[i].holes[at];
      const auto& offset = scene.fasteners[i].offset[at];
      for (Index d = 0; d < joint.n_directions(); ++d) shapes[hole.plate].D[hole.disc + d] += offset[joint.axes[d]];
      if (joint.n_directions() == 1 && offset[1 - joint.axes[0]] != 0)
        refuse(scene.fasteners[i].where + "/offset",
               fmt::format("{:g} along {}, along which the discs of this joint do not move", offset[1 - joint.axes[0]],
                           rim::axis_names[1 - joint.axes[0]]),
               "0 there, or sheets with \"disc_directions\" x and y");
    }
  return shapes;
}

VectorXd free_offsets(const JointModel& joint, const std::vector<FreeShape>& shapes) {
  const Index a = joint.n_directions();
  VectorXd offset = VectorXd::Zero(joint.n_planes() * a);
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const HoleModel& first = joint.first_hole(plane);
    offset.segment(j * a, a) += shapes[first.plate].D.segment(first.disc, a);
    if (joint.is_to_ground(plane)) continue;
    const HoleModel& second = joint.second_hole(plane);
    offset.segment(j * a, a) -= shapes[second.plate].D.segment(second.disc, a);
  }
  constexpr double rounding = 1e-12;  // of the largest displacement
  double largest = 0;
  for (const auto& shape : shapes)
    if (shape.D.size() > 0) largest = std::max(largest, shape.D.cwiseAbs().maxCoeff());
  offset = (offset.array().abs() > rounding * largest).select(offset, 0).eval();
  return offset.isZero(0) ? VectorXd() : offset;
}

double gap_growth(const JointModel& joint, const JointScene& scene, const CaseScene& its, Index fastener, Index at) {
  const FastenerScene& of = scene.fasteners[fastener];
  if (!of.expansion) return 0;
  const HoleModel& hole = joint.fasteners[fastener].holes[at];
  const PlateModel& plate = joint.plates[hole.plate];
  const auto rim = std::ranges::find(plate.contact, plate.hole_of(hole.disc), &formats::ContactRim::hole);
  if (rim == plate.contact.end()) return 0;
  double mean = 0;
  for (const auto& each : of.between) mean += temperature_of(its, each.plate) / double(of.between.size());
  const double sheet = temperature_of(its, plate.name), shank = its.fastener_temperature.value_or(mean);
  const double of_sheet = plate.expansion.size() > 0 ? plate.expansion.head(2).mean() * sheet : 0;
  return rim->radius * (of_sheet - *of.expansion * shank);
}

}  // namespace fastjoint::stage3
