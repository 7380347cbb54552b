// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/plate_model.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <set>

#include "common/errors.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::MatrixXd;

/// Rounding of stage 2 is far below; laboratory matrices must be made symmetric before they come here.
constexpr double symmetry_tolerance = 1e-8;

void check_once(const std::string& file, const char* dataset, const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const auto& name : names)
    if (!seen.insert(name).second)
      throw FileError(fmt::format("{}:{}: \"{}\" stands twice, expected each name once", file, dataset, name));
}

int axis(const std::string& file, const std::string& place, const std::string& name) {
  for (int i = 0; i < 2; ++i)
    if (name == axis_names[i]) return i;
  throw FileError(fmt::format("{}:{}: is \"{}\", expected \"x\" or \"y\"", file, place, name));
}

/// Directions of the first hole's discs; every other hole must have the same in the same order, one after the other.
std::vector<int> disc_axes(const std::string& file, const formats::PlateMatrices& a) {
  std::vector<int> axes;
  for (std::size_t i = 0; i < a.disc_hole.size() && a.disc_hole[i] == a.disc_hole[0]; ++i) {
    const int next = axis(file, "disc/direction", a.disc_direction[i]);
    if (std::find(axes.begin(), axes.end(), next) != axes.end()) break;  // check_once says why
    axes.push_back(next);
  }
  for (std::size_t i = 0; i < a.disc_hole.size(); ++i) {
    const std::size_t first = i - i % axes.size();
    if (a.disc_hole[i] == a.disc_hole[first] &&
        axis(file, "disc/direction", a.disc_direction[i]) == axes[i % axes.size()] &&
        a.disc_hole.size() % axes.size() == 0)
      continue;
    throw FileError(
        fmt::format("{}:disc/direction: hole \"{}\" has other directions than hole \"{}\", expected the same of every "
                    "disc, hole after hole",
                    file, a.disc_hole[i], a.disc_hole[0]));
  }
  return axes;
}

std::vector<int> axes_of(const std::string& file, const std::string& dataset, const std::vector<std::string>& names) {
  std::vector<int> axes;
  axes.reserve(names.size());
  for (const auto& name : names) axes.push_back(axis(file, dataset, name));
  return axes;
}

void check_symmetric(const std::string& file, const char* dataset, const MatrixXd& S) {
  if (S.size() == 0) return;
  const double largest = S.cwiseAbs().maxCoeff();
  Eigen::Index row = 0, col = 0;
  const double worst = (S - S.transpose()).cwiseAbs().maxCoeff(&row, &col);
  if (!(worst <= symmetry_tolerance * largest))
    throw FileError(
        fmt::format("{}:{}: is not symmetric: entries ({}, {}) and ({}, {}) are {} and {}, expected equal to {} of the "
                    "largest entry {}",
                    file, dataset, row, col, col, row, S(row, col), S(col, row), symmetry_tolerance, largest));
}

void check_not_negative(const std::string& file, const MatrixXd& S) {
  if (S.size() == 0) return;
  const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues()[0];
  if (!(least >= -symmetry_tolerance * S.cwiseAbs().maxCoeff()))
    throw FileError(
        fmt::format("{}:S_dd: the stiffness matrix [S_dd S_de; S_ed S_ee] has the eigenvalue {:.6g}, expected none "
                    "below zero: a plate cannot give energy",
                    file, least));
}

/// Largest error over the largest entry; unknown if the file has no estimate, p is not its highest degree, or S is
/// zero.
std::optional<double> relative_error(const MatrixXd& error, const MatrixXd& S) {
  if (!error.allFinite() || S.isZero(0)) return std::nullopt;
  return error.cwiseAbs().maxCoeff() / S.cwiseAbs().maxCoeff();
}

MatrixXd stacked(const MatrixXd& discs, const MatrixXd& externals) {
  MatrixXd A(discs.rows() + externals.rows(), discs.cols());
  A << discs, externals;
  return A;
}

/// Matrix S, or its error, of its parts.
MatrixXd joined(const MatrixXd& dd, const MatrixXd& ed, const MatrixXd& ee) {
  MatrixXd A(dd.rows() + ee.rows(), dd.rows() + ee.rows());
  A << dd, ed.transpose(), ed, ee;
  return A;
}

PlateDegrees degrees_up_to(const formats::PlateMatrices& a, int p) {
  constexpr std::size_t most = 4;  // no estimate looks further back
  std::map<int, std::size_t> levels;
  for (Eigen::Index i = 0; i < a.p.size(); ++i)
    if (a.p[i] <= p) levels.emplace(a.p[i], i);
  while (levels.size() > most) levels.erase(levels.begin());
  PlateDegrees degrees;
  degrees.p.resize(std::ssize(levels));
  for (const auto& [degree, level] : levels) {
    degrees.p[std::ssize(degrees.S)] = degree;
    degrees.S.push_back(joined(a.S_dd[level], a.S_ed[level], a.S_ee[level]));
    degrees.R.push_back(stacked(a.R_df[level], a.R_ef[level]));
    degrees.T.push_back(stacked(a.T_d[level], a.T_e[level]));
    degrees.C.push_back(a.C_t[level]);
  }
  return degrees;
}

MatrixXd error_of(const formats::PlateMatrices& a, int p) {
  const MatrixXd error = joined(a.S_dd_error, a.S_ed_error, a.S_ee_error);
  return p == a.p.maxCoeff() ? error
                             : MatrixXd::Constant(error.rows(), error.cols(), std::numeric_limits<double>::infinity());
}

std::size_t level_of(const formats::PlateMatrices& a, int p) {
  for (Eigen::Index i = 0; i < a.p.size(); ++i)
    if (a.p[i] == p) return i;
  throw std::logic_error("make_plate: degree not in the file");
}

MatrixXd stiffness(const std::string& file, const formats::PlateMatrices& a, std::size_t level) {
  check_symmetric(file, "S_dd", a.S_dd[level]);
  check_symmetric(file, "S_ee", a.S_ee[level]);
  MatrixXd S = joined(a.S_dd[level], a.S_ed[level], a.S_ee[level]);
  check_not_negative(file, S);
  return S;
}

}  // namespace

PlateModel make_plate(const std::string& name, const std::string& file, formats::PlateMatrices a, int p) {
  if (a.disc_hole.empty()) throw FileError(fmt::format("{}:disc/hole: is empty, expected at least one disc", file));
  std::vector<std::string> boundaries = a.external_id;
  boundaries.insert(boundaries.end(), a.traction_id.begin(), a.traction_id.end());
  check_once(file, "external/id", boundaries);
  const std::size_t level = level_of(a, p);
  PlateModel plate;
  plate.name = name;
  plate.file = file;
  plate.matrices_digest = a.header.digest;
  plate.plate_digest = a.plate_digest;
  plate.axes = disc_axes(file, a);
  for (std::size_t i = 0; i < a.disc_hole.size(); i += plate.axes.size()) {
    plate.holes.push_back(a.disc_hole[i]);
    plate.on_springs.push_back(a.disc_modulus[i] > 0);
  }
  check_once(file, "disc/hole", plate.holes);
  plate.externals = a.external_id;
  plate.tractions = a.traction_id;
  plate.S = stiffness(file, a, level);
  plate.R = stacked(a.R_df[level], a.R_ef[level]);
  plate.T = stacked(a.T_d[level], a.T_e[level]);
  plate.friction_hole = a.friction_hole;
  plate.friction_bearing = a.friction_bearing;
  plate.friction_unit_force = a.friction_unit_force;
  plate.friction_resultant = a.friction_resultant;
  plate.external_axis = axes_of(file, "external/direction", a.external_direction);
  plate.traction_axis = axes_of(file, "traction/direction", a.traction_direction);
  plate.degrees = degrees_up_to(a, p);
  plate.S_error = error_of(a, p);
  plate.relative_error = relative_error(plate.S_error, plate.S);
  plate.stresses = std::move(a.stresses);
  const auto& levels = plate.stresses.p;
  if (const auto at = std::find(levels.begin(), levels.end(), p); at != levels.end())
    plate.stress_level = at - levels.begin();
  plate.external_force = Eigen::VectorXd::Zero(a.n_externals());
  plate.external_displacement.resize(a.external_id.size());
  plate.traction_force = Eigen::VectorXd::Zero(a.n_tractions());
  return plate;
}

}  // namespace fastjoint::stage3
