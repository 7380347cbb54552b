// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/plate_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

/// The rounding of stage 2 is far smaller; measured matrices must be made symmetric before they come here.
constexpr double symmetry_tolerance = 1e-8;

void check_once(const std::string& file, const char* dataset, const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const auto& name : names)
    if (!seen.insert(name).second)
      throw FileError(fmt::format("{}:{}: \"{}\" stands twice, expected each name once", file, dataset, name));
}

std::vector<int> axes_of(const std::string& file, const char* dataset, const std::vector<std::string>& names) {
  std::vector<int> axes;
  axes.reserve(names.size());
  for (const auto& name : names) {
    axes.push_back(index_of(rim::axis_names, name));
    if (axes.back() == count_of(rim::axis_names))
      throw FileError(fmt::format("{}:{}: is \"{}\", expected \"x\" or \"y\"", file, dataset, name));
  }
  return axes;
}

/// Axes of the tractions; 0 for moments, which have an arm.
std::vector<int> traction_axes(const std::string& file, const formats::PlateMatrices& a) {
  std::vector<std::string> names = a.traction_direction;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double arm = i < a.traction_arm.size() ? a.traction_arm[i] : 0;
    if ((names[i] == formats::rotation) != (arm > 0))
      throw FileError(
          fmt::format("{}:traction/arm: is {:g} for the direction \"{}\", expected an arm above 0 for "
                      "\"rotation\", and 0 for \"x\" and \"y\"",
                      file, arm, names[i]));
    if (names[i] == formats::rotation) names[i] = rim::axis_names[0];
  }
  return axes_of(file, "traction/direction", names);
}

/// Names the holes, and finds the index of each disc of the file among the discs of all directions. Discs of a hole
/// must follow each other; a repeated direction counts as another hole, which check_once refuses.
void place_discs(const std::string& file, const formats::PlateMatrices& a, PlateModel& plate) {
  const auto axes = axes_of(file, "disc/direction", a.disc_direction);
  for (Index i = 0; i < std::ssize(axes); ++i) {
    if (i == 0 || a.disc_hole[i] != a.disc_hole[i - 1] || axes[i] == axes[i - 1]) {
      plate.holes.push_back(a.disc_hole[i]);
      plate.on_springs.push_back(a.disc_modulus[i] > 0);
    }
    const Index first = (std::ssize(plate.holes) - 1) * std::ssize(plate.axes);
    const Index at = first + index_of(plate.axes, axes[i]);
    if (!plate.discs.empty() && at <= plate.discs.back())
      throw FileError(
          fmt::format("{}:disc/direction: hole \"{}\" has {} after {}, expected each direction once, all in "
                      "one order",
                      file, a.disc_hole[i], a.disc_direction[i], a.disc_direction[i - 1]));
    plate.discs.push_back(at);
  }
  check_once(file, "disc/hole", plate.holes);
}

/// True if a traction is the other side of the hole of the one before.
bool is_other_side(const formats::PlateMatrices& a, Index traction) {
  if (traction == 0 || a.traction_id[traction] != a.traction_id[traction - 1]) return false;
  const auto &bearing = a.traction_bearing[traction], &before = a.traction_bearing[traction - 1];
  return !bearing.empty() && !before.empty() && bearing[0] != before[0];
}

/// Refuses rims of contact whose hole has no disc, and more than one rim of a hole.
void check_contact(const std::string& file, const formats::PlateMatrices& a, const PlateModel& plate) {
  std::vector<std::string> names;
  for (const auto& rim : a.contact) {
    if (std::ranges::find(plate.holes, rim.hole) == plate.holes.end())
      throw FileError(fmt::format("{}:pressure/hole: holds \"{}\", expected holes in disc/hole", file, rim.hole));
    names.push_back(rim.hole);
  }
  check_once(file, "pressure/hole", names);
}

void check_symmetric(const std::string& file, const char* dataset, const MatrixXd& S) {
  if (S.size() == 0) return;
  const double largest = S.cwiseAbs().maxCoeff();
  Index row = 0, col = 0;
  const double worst = (S - S.transpose()).cwiseAbs().maxCoeff(&row, &col);
  if (!(worst <= symmetry_tolerance * largest))
    throw FileError(
        fmt::format("{}:{}: is not symmetric: entries ({}, {}) and ({}, {}) are {} and {}, expected equal to {} of the "
                    "largest entry {}",
                    file, dataset, row, col, col, row, S(row, col), S(col, row), symmetry_tolerance, largest));
}

/// The smallest eigenvalue of a stiffness if it is below zero by more than rounding, else 0.
double negative_eigenvalue(const MatrixXd& S) {
  if (S.size() == 0) return 0;
  const double allowed = symmetry_tolerance * S.cwiseAbs().maxCoeff();
  MatrixXd lifted = S;
  lifted.diagonal().array() += allowed;
  if (matrices::is_positive_definite(lifted)) return 0;
  const double smallest = matrices::symmetric_eigenvalues(S)[0];
  return smallest >= -allowed ? 0 : smallest;
}

/// Checks the stiffness of the file, and that of the plate with the waves of its rims of contact as unknowns.
void check_not_negative(const std::string& file, const formats::PlateMatrices& a, const MatrixXd& of_file,
                        const MatrixXd& S) {
  const double smallest = negative_eigenvalue(S);
  if (smallest == 0) return;
  if (const double own = a.contact.empty() ? smallest : negative_eigenvalue(of_file); own != 0)
    throw FileError(
        fmt::format("{}:S_dd: the stiffness matrix [S_dd S_de; S_ed S_ee] has the eigenvalue {:.6g}, expected none "
                    "below zero: the strain energy of a plate is not negative",
                    file, own));
  std::vector<std::string> holes;
  for (std::size_t i = 0; i < a.contact.size(); ++i)
    holes.push_back(fmt::format("{} (order {})", a.waves[i].hole, a.waves[i].waves.highest));
  throw NumericalError(fmt::format(
      "{}: at this degree the elements do not follow the waves around holes in contact, {}; allowed: a higher "
      "--p, or a smaller \"waves\" of these holes in the input of stage1_plate",
      file, fmt::join(holes, ", ")));
}

MatrixXd stacked(const MatrixXd& discs, const MatrixXd& externals) {
  MatrixXd A(discs.rows() + externals.rows(), discs.cols());
  A << discs, externals;
  return A;
}

/// Matrix S, or its error, from its blocks.
MatrixXd joined(const MatrixXd& dd, const MatrixXd& ed, const MatrixXd& ee) {
  MatrixXd A(dd.rows() + ee.rows(), dd.rows() + ee.rows());
  A << dd, ed.transpose(), ed, ee;
  return A;
}

/// Raises the compliance of pressures whose waves are too short for the sheet's degree to a small minimum.
void soften_unresolved(const formats::PlateMatrices& a, MatrixXd& compliance) {
  constexpr double min_ratio = 1e-3;  // to the largest eigenvalue of the rim
  Index row = 0;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    const Index k = a.waves[i].waves.size();
    const auto eigen = matrices::symmetric_eigen(compliance.block(row, row, k, k));
    const double min_value = min_ratio * eigen.values[k - 1];
    const auto n = (eigen.values.array() < min_value).count();
    const auto unresolved = eigen.vectors.leftCols(n);
    compliance.block(row, row, k, k) += min_value * unresolved * unresolved.transpose();
    row += k;
  }
}

/// What ContactWaves take from the compliance of a plate, of all rims, with the springs of its rims, (k), length /
/// force.
VectorXd moved_of(const formats::PlateMatrices& a,
                  const std::vector<std::shared_ptr<const ContactWaves>>& contact_waves) {
  std::vector<double> moved;
  for (Index i = 0; i < std::ssize(a.contact); ++i)
    for (const double its : contact_waves[i]->fewest().moved)
      moved.push_back(its / (1 + a.contact[i].modulus * its) / a.contact[i].area);
  return Eigen::Map<const VectorXd>(moved.data(), std::ssize(moved));
}

/// The waves of the rims of a plate, which take as much of its compliance as it has to spare at all degrees in use.
std::vector<std::shared_ptr<const ContactWaves>> waves_of_rims(const formats::PlateMatrices& a, Index first,
                                                               Index level) {
  auto waves = contact_waves_of(a);
  const VectorXd moved = moved_of(a, waves);
  if (moved.isZero(0)) return waves;
  constexpr double spare = 1.5;
  for (Index i = first; i <= level; ++i) {
    MatrixXd compliance = rim_matrices(a, i).C;
    compliance.diagonal() -= spare * moved;
    if (!matrices::is_positive_definite(compliance)) return contact_waves_of(a, false);
  }
  return waves;
}

/// Fixes the short waves of the rims of a plate at zero: replaces its moments d by those of ShortWaves, delta = d +
/// C_fixed p + R_fixed tau, where p is minus the force on the moments over the area. In an isotropic sheet d = delta.
void fix_short_waves(const formats::PlateMatrices& a, const std::vector<std::shared_ptr<const ContactWaves>>& rims,
                     PlateDegree& at) {
  MatrixXd &S = at.S, &R = at.R, &T = at.T;
  Index k = 0, n_shears = 0;
  bool uncoupled = true;
  for (const auto& rim : rims) {
    const ShortWaves& its = rim->fewest();
    k += its.n_long;
    n_shears += its.n_long_shears;
    uncoupled = uncoupled && its.C_fixed.isZero(0) && its.R_fixed.isZero(0);
  }
  if (uncoupled) return;
  MatrixXd C = MatrixXd::Zero(k, k), by_shear = MatrixXd::Zero(k, R.cols());  // by forces, and by all columns of R
  for (Index i = 0, row = 0, column = R.cols() - n_shears; i < std::ssize(rims); ++i) {
    const ShortWaves& its = rims[i]->fewest();
    C.block(row, row, its.n_long, its.n_long) = its.C_fixed / a.contact[i].area;
    by_shear.block(row, column, its.n_long, its.n_long_shears) = its.R_fixed;
    row += its.n_long, column += its.n_long_shears;
  }
  R -= S.rightCols(k) * by_shear;
  const MatrixXd softened = MatrixXd::Identity(k, k) - S.bottomRightCorner(k, k) * C;
  const matrices::Lu lu(softened);
  const MatrixXd of_S = lu.solve(S.bottomRows(k)), of_R = lu.solve(R.bottomRows(k)), of_T = lu.solve(T.bottomRows(k));
  const Index n = S.rows() - k;
  at.C -= T.bottomRows(k).transpose() * C * of_T;
  const MatrixXd forward = S.topRightCorner(n, k) * C;
  S.topRows(n) += forward * of_S;
  R.topRows(n) += forward * of_R;
  T.topRows(n) += forward * of_T;
  S.bottomRows(k) = of_S;
  R.bottomRows(k) = of_R;
  T.bottomRows(k) = of_T;
  S = (0.5 * (S + S.transpose())).eval();
}

/// Replaces the matrices of a plate with all its springs, whose rims of contact carry pressures q in addition, by those
/// of the plate without the springs of these rims and with their moments as unknowns. F = S u + B^T q + R Lambda + T f
/// and m = B u - C q + R_p Lambda + T_p f give q, and the force on the moments is K A m - q (docs/theory.md,
/// section 6.3). What ShortWaves::moved says is taken from their compliance (section 6.8). The shears of these rims
/// follow the friction cases in R.
void free_rims(const std::string& file, const formats::PlateMatrices& a, Index level,
               const std::vector<std::shared_ptr<const ContactWaves>>& contact_waves, PlateDegree& at) {
  const Index n = at.S.rows();
  if (a.contact.empty()) return;
  RimMatrices rims = rim_matrices(a, level);
  const Index k = rims.C.rows();
  VectorXd springs(k), scale(k);
  Index row = 0;
  for (Index i = 0; i < std::ssize(a.contact); ++i) {
    const Index n_long = a.waves[i].waves.size();
    const double K = a.contact[i].modulus, area = a.contact[i].area;
    const VectorXd& its = contact_waves[i]->fewest().moved;
    scale.segment(row, n_long) = (1 + K * its.array()).inverse();
    springs.segment(row, n_long) = K * area * scale.segment(row, n_long);
    row += n_long;
  }
  const MatrixXd& B = rims.B;
  MatrixXd& compliance = rims.C;
  compliance.diagonal() -= moved_of(a, contact_waves);
  auto inverse = matrices::inverse_of_positive(compliance);
  constexpr double max_ratio = 1e6;  // to the stiffness of the springs
  if (!inverse || !((inverse->diagonal().array() / springs.array()).maxCoeff() < max_ratio)) {
    soften_unresolved(a, compliance);
    inverse = matrices::inverse_of_positive(compliance);
  }
  if (!inverse) throw FileError(file + ":W: the compliance under unit pressures is not positive definite");
  const MatrixXd& stiffness = *inverse;
  compliance.resize(0, 0);  // these matrices are the largest of a run
  const MatrixXd by_motion = stiffness * B, by_traction = stiffness * rims.T;
  const auto extended = [&](const MatrixXd& load, const MatrixXd& of_rims, const MatrixXd& moments,
                            const MatrixXd& moments_of_rims) {
    MatrixXd all(n + k, load.cols() + of_rims.cols());
    all << load, of_rims, moments, moments_of_rims;
    all.bottomRows(k) = (stiffness * all.bottomRows(k)).eval();
    all.topRows(n).noalias() += B.transpose() * all.bottomRows(k);
    all.bottomRows(k) = -(scale.asDiagonal() * all.bottomRows(k));
    return all;
  };
  at.C -= rims.T.transpose() * by_traction;
  at.R = extended(at.R, rims.R, rims.R_f, rims.R_p);
  at.T = extended(at.T, MatrixXd(n, 0), rims.T, MatrixXd(k, 0));
  MatrixXd S(n + k, n + k);
  const auto D = scale.asDiagonal();
  S << at.S + B.transpose() * by_motion, -by_motion.transpose() * D, -(D * by_motion), D * stiffness * D;
  S.diagonal().tail(k) -= springs;
  at.S = std::move(S);
  fix_short_waves(a, contact_waves, at);
}

/// Adds rows and columns for the displacements of discs that the file does not have, since symmetry fixes them. They
/// are uncoupled from the others and have a stiffness of their own but no force, so that they stay zero.
void add_fixed_discs(const PlateModel& plate, PlateDegree& at) {
  const Index n_file = std::ssize(plate.discs), more = plate.n_disc_unknowns() - n_file;
  if (more == 0) return;
  const Index n = at.S.rows() + more;
  std::vector<Index> place(plate.discs);
  for (Index i = plate.n_disc_unknowns(); i < n; ++i) place.push_back(i);
  MatrixXd S = at.S.diagonal().head(n_file).maxCoeff() * MatrixXd::Identity(n, n);
  for (const Index i : place) S(i, i) = 0;
  S(place, place) = at.S;
  at.S = std::move(S);
  for (MatrixXd* load : {&at.R, &at.T}) {
    MatrixXd all = MatrixXd::Zero(n, load->cols());
    all(place, Eigen::all) = *load;
    *load = std::move(all);
  }
}

/// The lowest of the degrees that are used besides one: no error estimate needs more than four.
Index first_degree(Index level) { return std::max<Index>(level - 3, 0); }

PlateDegree degree_of(const std::string& file, const formats::PlateMatrices& a, Index level, const PlateModel& plate) {
  PlateDegree at{a.p[level], joined(a.S_dd[level], a.S_ed[level], a.S_ee[level]), stacked(a.R_df[level], a.R_ef[level]),
                 stacked(a.T_d[level], a.T_e[level]), a.C_t[level]};
  free_rims(file, a, level, plate.contact_waves, at);
  add_fixed_discs(plate, at);
  return at;
}

/// JSON text of the materials in the text of a PLATE.json; empty if that is not known.
std::string materials_in(const std::string& input) {
  const auto json = nlohmann::json::parse(input, nullptr, false, true);
  const auto found = json.is_object() ? json.find("materials") : json.end();
  return found != json.end() ? found->dump() : "";
}

}  // namespace

std::optional<rim::SignedAxis> bearing_side(const std::string& name) {
  const bool known = name.size() == 2 && (name[0] == '+' || name[0] == '-') && (name[1] == 'x' || name[1] == 'y');
  return known ? std::optional(rim::signed_axis_named(name)) : std::nullopt;
}

std::vector<int> joint_axes(std::span<const std::string> files, std::span<const formats::UnitCases> all) {
  std::set<int> found;
  std::vector<int> of_one_hole;  // the order is that of a hole with both directions: a half hole has only one
  for (Index i = 0; i < std::ssize(all); ++i) {
    const auto axes = axes_of(files[i], "disc/direction", all[i].disc_direction);
    for (Index disc = 0; disc < std::ssize(axes); ++disc) {
      found.insert(axes[disc]);
      if (of_one_hole.empty() && disc > 0 && all[i].disc_hole[disc] == all[i].disc_hole[disc - 1] &&
          axes[disc] != axes[disc - 1])
        of_one_hole = {axes[disc - 1], axes[disc]};
    }
  }
  if (found.empty()) return {0, 1};  // sheets without discs
  return of_one_hole.empty() ? std::vector<int>(found.begin(), found.end()) : of_one_hole;
}

PlateModel make_plate(const std::string& name, const std::string& file, formats::PlateMatrices a, int p,
                      const std::vector<int>& axes) {
  std::vector<std::string> boundaries = a.external_id;
  for (Index i = 0; i < a.n_tractions(); ++i)
    if (!is_other_side(a, i)) boundaries.push_back(a.traction_id[i]);
  check_once(file, "external/id", boundaries);
  const Index level = std::find(a.p.begin(), a.p.end(), p) - a.p.begin();
  if (level == a.p.size()) throw std::logic_error("make_plate: degree not in the file");
  PlateModel plate;
  plate.name = name;
  plate.file = file;
  plate.materials = materials_in(a.header.input);
  const formats::UnitCases& own = a;
  plate.axes = axes.empty() ? joint_axes({&file, 1}, {&own, 1}) : axes;
  place_discs(file, a, plate);
  check_contact(file, a, plate);
  check_symmetric(file, "S_dd", a.S_dd[level]);
  check_symmetric(file, "S_ee", a.S_ee[level]);
  plate.contact_waves = waves_of_rims(a, first_degree(level), level);
  for (Index i = first_degree(level); i < level; ++i) {
    plate.lower.push_back(degree_of(file, a, i, plate));
    if (i + 1 == level) continue;
    plate.lower.back().R.resize(0, 0);
    if (!a.W.empty()) a.W[i].resize(0, 0);  // may be as large as all that is kept
  }
  static_cast<PlateDegree&>(plate) = degree_of(file, a, level, plate);
  check_not_negative(file, a, joined(a.S_dd[level], a.S_ed[level], a.S_ee[level]), plate.S);
  plate.external_axis = axes_of(file, "external/direction", a.external_direction);
  plate.traction_axis = traction_axes(file, a);
  plate.unsupported_axes = axes_of(file, "unsupported", a.unsupported);
  plate.S_error = joined(a.S_dd_error, a.S_ed_error, a.S_ee_error);
  if (level + 1 < a.p.size() || plate.S_error.rows() != plate.S.rows() || !plate.S_error.allFinite())
    plate.S_error.resize(0, 0);
  formats::PlateProperties& properties = a;  // without the matrices by degree
  static_cast<formats::PlateProperties&>(plate) = std::move(properties);
  plate.header.input.clear();
  for (auto* rows : {&plate.cracks.K_I, &plate.cracks.K_II})
    if (!rows->empty()) *rows = {std::move((*rows)[level])};
  if (const int at = index_of(plate.stresses.p, p); at < count_of(plate.stresses.p)) {
    plate.stress_level = at;
    plate.spring_waves = spring_waves(plate.waves);
    for (Index before = 0; before <= at; ++before) {
      const auto& others = plate.stresses.other_waves[at - before];
      MatrixXd& rows = plate.wave_rows.emplace_back(plate.n_waves(), plate.n_cases());
      rows << a.W[level - before], others;
    }
  }
  return plate;
}

}  // namespace fastjoint::stage3
