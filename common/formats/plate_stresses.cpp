// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_stresses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

/// The unit of a column depends on its case.
constexpr const char* per_case = "per unit of the case";

Eigen::Index count(const std::vector<std::string>& names) { return names.size(); }

void check_starts(const h5::Reader& file, const Eigen::VectorXi& start, Eigen::Index n_points) {
  const bool steps_up =
      start[0] == 0 && start[start.size() - 1] == n_points && std::is_sorted(start.begin(), start.end());
  if (!steps_up)
    throw FileError(
        fmt::format("{}:rim/start: does not rise from 0 to the {} points of rim/angle", file.path(), n_points));
}

}  // namespace

void write_stresses(h5::Writer& file, const PlateStresses& a, const Units& units) {
  const std::string length = unit(units, 1, 0);
  const std::string area = unit(units, 2, 0);
  file.write("stress/p", a.p, {"1", "degrees of the stresses and section forces"});
  file.write("rim/hole", a.rim_hole, {"1", "holes, open ones included"});
  file.write("rim/center", a.rim_center, {length, "x and y of each hole's centre"});
  file.write("rim/radius", a.rim_radius, {length, "radius of each hole"});
  file.write("rim/thickness", a.rim_thickness, {length, "mean thickness of the sheet at the rim"});
  file.write("rim/modulus", a.rim_modulus, {unit(units, -2, 1), "mean modulus in tension there along x, along y"});
  file.write("rim/bearing_area", a.bearing_area, {area, "projected area of the rim that bears along x, along y"});
  file.write("rim/start", a.rim_start, {"1", "first point of each rim, and the number of points"});
  file.write("rim/angle", a.angle, {"deg", "place of each point on its rim, counter-clockwise from x"});
  const auto k = a.angle.size();
  const auto n_cases = a.sigma_tt.empty() ? 0 : a.sigma_tt[0].cols();
  file.write("rim/sigma_rr", a.sigma_rr, k, n_cases, {per_case, "radial stress at each point in each unit case"});
  file.write("rim/sigma_tt", a.sigma_tt, k, n_cases, {per_case, "hoop stress"});
  file.write("rim/sigma_rt", a.sigma_rt, k, n_cases, {per_case, "shear stress"});
  file.write("section/hole", a.section_hole, {"1", "hole that each section lies beside"});
  file.write("section/side", a.section_side, {"1", "on which side of it"});
  file.write("section/gross_area", a.gross_area, {area, "area of the section"});
  file.write("section/net_area", a.net_area, {area, "that area less the hole's"});
  file.write("section/force", a.section_force, count(a.section_hole), n_cases,
             {per_case, "normal force over the section in each unit case, tension positive"});
}

PlateStresses read_stresses(const h5::Reader& file, Eigen::Index n_cases, const Units& units) {
  PlateStresses a;
  if (!file.has("stress/p")) return a;
  a.p = file.integers("stress/p", h5::any);
  if (a.p.size() > 0) check_degrees(file, "stress/p", a.p, highest_degree);
  const std::string length = expected_unit(units, 1, 0);
  const std::string area = expected_unit(units, 2, 0);
  a.rim_hole = file.strings("rim/hole", h5::any);
  const auto r = count(a.rim_hole);
  if (r == 0 && a.p.size() == 0) return a;
  a.rim_center = file.matrix("rim/center", r, 2, length);
  a.rim_radius = file.vector("rim/radius", r, length);
  a.rim_thickness = Eigen::VectorXd::Zero(r);
  a.rim_modulus = Eigen::MatrixXd::Zero(r, 2);
  if (file.has("rim/thickness")) a.rim_thickness = file.vector("rim/thickness", r, length);
  if (file.has("rim/modulus")) a.rim_modulus = file.matrix("rim/modulus", r, 2, expected_unit(units, -2, 1));
  a.bearing_area = file.matrix("rim/bearing_area", r, 2, area);
  a.rim_start = file.integers("rim/start", r + 1);
  a.angle = file.vector("rim/angle", h5::any, "deg");
  check_starts(file, a.rim_start, a.angle.size());
  if ((a.bearing_area.array() <= 0).any())
    throw FileError(
        fmt::format("{}:rim/bearing_area: holds {}, expected numbers > 0", file.path(), a.bearing_area.minCoeff()));
  if (a.p.size() == 0) return a;
  const auto stack = [&](const char* dataset, Eigen::Index rows) {
    return file.stack(dataset, a.p.size(), rows, n_cases, per_case);
  };
  a.sigma_rr = stack("rim/sigma_rr", a.angle.size());
  a.sigma_tt = stack("rim/sigma_tt", a.angle.size());
  a.sigma_rt = stack("rim/sigma_rt", a.angle.size());
  a.section_hole = file.strings("section/hole", h5::any);
  const auto s = count(a.section_hole);
  a.section_side = file.strings("section/side", s);
  check_words(file, "section/side", a.section_side, side_names);
  a.gross_area = file.vector("section/gross_area", s, area);
  a.net_area = file.vector("section/net_area", s, area);
  a.section_force = stack("section/force", s);
  return a;
}

}  // namespace fastjoint::formats
