// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/program/program.hpp"
#include "stage2_extract/field/joint_sheet.hpp"

namespace fastjoint::stage2 {
namespace {

using formats::PlateSolution;

bool starts_as_case(const std::string& spec) {
  constexpr std::string_view kinds[] = {"external:", "disc:", "wave:", "friction:", "traction:"};
  return std::any_of(std::begin(kinds), std::end(kinds), [&](auto kind) { return spec.starts_with(kind); });
}

bool names_a_file(const std::string& spec) {
  std::error_code ignored;
  return !starts_as_case(spec) && (spec.ends_with(".h5") || std::filesystem::exists(spec, ignored));
}

/// Index of the longest name at the start of the text that is followed by a comma, "=" or its end; -1 if there is none.
std::ptrdiff_t first_case(const std::vector<std::string>& names, std::string_view text) {
  std::ptrdiff_t longest = -1;
  for (int i = 0; i < count_of(names); ++i) {
    const auto& name = names[i];
    if (!text.starts_with(name)) continue;
    if (text.size() > name.size() && text[name.size()] != ',' && text[name.size()] != '=') continue;
    if (longest < 0 || name.size() > names[longest].size()) longest = i;
  }
  return longest;
}

/// Reads the coefficient at the start of the text and removes it.
double take_coefficient(std::string_view& text, const std::string& name) {
  if (text.empty() || text[0] != '=') return 1;
  const auto word = text.substr(1, text.find(',') - 1);
  double coefficient = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), coefficient);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(coefficient))
    throw InputError(fmt::format(
        "--field: '{}' is not allowed as the coefficient of {}; allowed: a number such as 0.01", word, name));
  text.remove_prefix(1 + word.size());
  return coefficient;
}

/// Selects the case for the sign of a traction's force, if the hole has one case of the same name for each side.
std::ptrdiff_t case_of_sign(const PlateSolution& plate, const std::vector<std::string>& names, std::ptrdiff_t first,
                            double coefficient) {
  const auto traction = first - (std::ssize(names) - plate.n_tractions());
  if (traction < 0 || coefficient >= 0) return first;
  if (first + 1 < std::ssize(names) && names[first + 1] == names[first]) return first + 1;
  if (traction < std::ssize(plate.traction_bearing) && !plate.traction_bearing[traction].empty())
    throw InputError(
        fmt::format("--field: {} is not allowed as the coefficient of {}: the model has no rim on the side of "
                    "the hole that would bear; allowed: a number >= 0",
                    coefficient, names[first]));
  return first;
}

FieldState case_sum(const PlateSolution& plate, const std::string& spec) {
  if (plate.held_at.size() > 0)
    throw InputError(
        fmt::format("--field: '{}' is a sum of cases of a sheet that nothing holds, each of which is balanced "
                    "by tractions of its own; allowed: the RESULT.h5 of a joint under loads in balance",
                    spec));
  const auto names = case_names(plate);
  auto shown = names;  // without the repeated names of tractions that have a case for each side of a hole
  shown.erase(std::unique(shown.end() - plate.n_tractions(), shown.end()), shown.end());
  FieldState state{Eigen::VectorXd::Zero(names.size()), spec};
  std::vector<bool> given(names.size());
  for (std::string_view rest = spec;;) {
    const auto found = first_case(names, rest);
    if (found < 0)
      throw InputError(fmt::format(
          "--field: '{}' is not a case of the plate{}; allowed: a RESULT.h5, or a sum CASE=COEFFICIENT,... of "
          "the cases {}",
          rest, starts_as_case(spec) ? "" : " nor a file", listed(shown)));
    if (given[found]) throw InputError(fmt::format("--field: {} stands twice; allowed: each case once", names[found]));
    given[found] = true;
    rest.remove_prefix(names[found].size());
    const double coefficient = take_coefficient(rest, names[found]);
    state.coefficients[case_of_sign(plate, names, found, coefficient)] = coefficient;
    if (rest.empty()) return state;
    rest.remove_prefix(1);  // the comma
  }
}

/// The last increment of a case, from 1 on.
int last_of_case(const formats::JointResult& joint, const FieldRequest& request) {
  if (joint.case_name == std::vector<std::string>{""})
    throw InputError(fmt::format("--case: \"{}\"; allowed: no such option: {} is of a joint without \"cases\"",
                                 request.of_case, request.spec));
  const int at = index_of(joint.case_name, request.of_case);
  for (int step = count_of(joint.load_factor); step > 0; --step)
    if (joint.case_of[step - 1] == at) return step;
  const bool is_known = at < count_of(joint.case_name);
  throw InputError(fmt::format("--case: \"{}\" {} in {}; allowed: {}", request.of_case,
                               is_known ? "has no increment that converged" : "is no case", request.spec,
                               listed(joint.case_name)));
}

FieldState joint_state(const PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  const auto sheet = read_joint_sheet(plate, file, request.spec, request.plate);
  const auto steps = count_of(sheet.joint.load_factor);
  if (request.increment > steps)
    throw InputError(fmt::format("--increment: {} is not allowed; {} has the increments 1..{}", request.increment,
                                 request.spec, steps));
  FieldState state;
  const int governing = sheet.joint.governing != 0 ? sheet.joint.governing : steps;
  const bool governs = request.increment == 0 && request.of_case.empty();
  state.increment = governs ? governing : request.increment;
  if (!request.of_case.empty()) state.increment = last_of_case(sheet.joint, request);
  state.joint_plate = sheet.joint.plates[sheet.at].name;
  state.p = sheet.joint.p;
  const auto step = state.increment - 1;
  const std::string& name = sheet.joint.header.name;
  const std::string& its = sheet.joint.case_name[sheet.joint.case_of[step]];
  state.words =
      fmt::format("{}increment {} of {}{}, load factor {:g}{}", name.empty() ? "" : name + ", ", state.increment, steps,
                  its.empty() ? "" : fmt::format(" in all, of case \"{}\"", its), sheet.joint.load_factor[step],
                  governs && sheet.joint.governing != 0 ? fmt::format(" ({})", sheet.joint.governing_reason) : "");
  state.coefficients = sheet.coefficients.col(step);
  return state;
}

}  // namespace

void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings) {
  if (!wanted && request.p != 0) throw InputError("--p: goes with --field only; matrices are of all degrees");
  const bool of_joint = wanted && names_a_file(request.spec);
  if (!of_joint && !request.plate.empty()) throw InputError("--plate: goes with --field RESULT.h5 only");
  if (!of_joint && request.increment != 0) throw InputError("--increment: goes with --field RESULT.h5 only");
  if (!of_joint && !request.of_case.empty()) throw InputError("--case: goes with --field RESULT.h5 only");
  if (request.increment != 0 && !request.of_case.empty())
    throw InputError("--case: given together with --increment; allowed: one of them");
  for (const auto& [option, path] : {std::pair("-o", output), std::pair("--timings", timings)})
    if (wanted) program::check_spare(option, path, request.spec, "the file of --field");
}

FieldState field_state(const PlateSolution& plate, const std::string& file, const FieldRequest& request) {
  if (names_a_file(request.spec)) return joint_state(plate, file, request);
  return case_sum(plate, request.spec);
}

int field_degree(const PlateSolution& plate, const std::string& file, const FieldRequest& request,
                 const FieldState& state) {
  const int highest = plate.p[plate.p.size() - 1];
  const int p = request.p != 0 ? request.p : state.p != 0 ? state.p : highest;
  if (p < 1 || p > highest)
    throw InputError(fmt::format("--p: {} is {}not allowed; {} has unknowns of the degrees 1 to {}", p,
                                 request.p != 0 ? "" : "the degree of the joint and ", file, highest));
  return p;
}

using Eigen::Index;

Eigen::Matrix2Xd lagrange_nodes(int p) {
  const Eigen::VectorXd inner = Eigen::VectorXd::LinSpaced(p + 1, -1, 1).segment(1, p - 1);
  const Index n = inner.size();
  Eigen::Matrix2Xd nodes(2, (p + 1) * (p + 1));
  nodes.leftCols<4>() << -1, 1, 1, -1,  //
      -1, -1, 1, 1;
  for (int edge = 0; edge < pfem::n_local_edges; ++edge)
    nodes.middleCols(4 + edge * n, n) = pfem::along_edge(edge, inner);
  for (Index j = 0; j < n; ++j) {
    auto row = nodes.middleCols(4 + (pfem::n_local_edges + j) * n, n);
    row.row(0) = inner.transpose();
    row.row(1).setConstant(inner[j]);
  }
  return nodes;
}

Field at_nodes(const Fields& fields, int p) {
  const auto& [solver, coefficients, states] = fields;
  const auto& mesh = solver.plate().mesh;
  const auto& [space, highest] = std::tie(solver.numbering().space, solver.numbering().p);
  assert(states.size() == 1);
  const Eigen::Matrix2Xd nodes = lagrange_nodes(p);
  const Eigen::VectorXd xi = nodes.row(0), eta = nodes.row(1);
  const Eigen::MatrixXd N = pfem::shape_values(space, highest, xi, eta).N;
  const Index n = nodes.cols(), n_points = n * mesh.n_elements();
  Field field{p, Eigen::Matrix2Xd(2, n_points), Eigen::Matrix2Xd(2, n_points), Eigen::Matrix3Xd(3, n_points)};
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const pfem::ElementMap map(mesh, solver.edges(), element);
    const Eigen::VectorXd c = states.coefficients(element);
    const Eigen::VectorXd strain = pfem::strain_operator(map, space, highest, xi, eta) * c;
    const Index first = element * n;
    for (Index i = 0; i < n; ++i) field.points.col(first + i) = map.point(xi[i], eta[i]);
    field.displacement.middleCols(first, n) << c.head(N.rows()).transpose() * N, c.tail(N.rows()).transpose() * N;
    field.stress.middleCols(first, n) = solver.elasticity(element) * strain.reshaped(3, n);
  }
  return field;
}

Field make_field(FieldSolver& solver, const std::string& file, const FieldRequest& request, const FieldState& state) {
  const int p = field_degree(solver.plate(), file, request, state);
  solver.factorise(p);
  Field field = at_nodes(solver.solve(state.coefficients), p);
  if (!field.displacement.allFinite() || !von_mises(field.stress).allFinite())
    throw NumericalError(
        fmt::format("{}: --field {}: displacements or stresses are too large for the numbers of this "
                    "machine; allowed: smaller coefficients",
                    file, request.spec));
  return field;
}

Eigen::VectorXd von_mises(const Eigen::Matrix3Xd& stress) {
  const auto x = stress.row(0).array(), y = stress.row(1).array(), xy = stress.row(2).array();
  return (x.square() - x * y + y.square() + 3 * xy.square()).sqrt().transpose();
}

Eigen::Matrix2Xd principal(const Eigen::Matrix3Xd& stress) {
  const auto x = stress.row(0).array(), y = stress.row(1).array(), xy = stress.row(2).array();
  const Eigen::RowVectorXd mean = (x + y) / 2;
  const Eigen::RowVectorXd radius = (((x - y) / 2).square() + xy.square()).sqrt();
  Eigen::Matrix2Xd result(2, stress.cols());
  result << mean + radius, mean - radius;
  return result;
}

}  // namespace fastjoint::stage2
