// SPDX-License-Identifier: GPL-3.0-or-later
// A peer on deal.II: the condensed stiffness S of a panel, by the product space of degree p on the elements that
// stage1_plate makes, and the hoop stresses at its rims for unit displacements if asked for. Prints S, those of the
// first rim, and the times of its phases as JSON.
#include <deal.II/base/multithread_info.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <iostream>

#include "common/linalg/processor.hpp"
#include "tests/bench/peer_elements.hpp"
#include "tests/bench/peer_plate.hpp"
#include "tests/bench/peer_stresses.hpp"

namespace fastjoint::peer {
namespace {

using namespace dealii;

/// Seconds of each phase, in their order.
class Phases {
 public:
  void begin(const std::string& name) {
    end();
    seconds_.emplace_back(name, 0.0);
    start_ = std::chrono::steady_clock::now();
  }
  void end() {
    if (seconds_.empty()) return;
    seconds_.back().second = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  [[nodiscard]] std::string json() const {
    std::string all;
    for (const auto& [name, seconds] : seconds_)
      all += fmt::format("{}\"{}\": {:.6f}", all.empty() ? "" : ", ", name, seconds);
    return fmt::format("{{{}}}", all);
  }

 private:
  std::vector<std::pair<std::string, double>> seconds_;
  std::chrono::steady_clock::time_point start_;
};

/// What is computed; of stresses nothing unless they are asked for.
struct Result {
  Eigen::MatrixXd S, hoop;
};

/// What rigid displacements of the external and the discs add: K U = -C, S = K_cc + C^T U.
struct Controlled {
  explicit Controlled(const Discretisation& plate)
      : C(Eigen::MatrixXd::Zero(plate.n_rows, plate.panel.n_controlled())),
        K_cc(Eigen::MatrixXd::Zero(C.cols(), C.cols())) {}
  void add(const FullMatrix<double>& K, const CellPlaces& at) {
    for (unsigned int j = 0; j < at.controlled.local.size(); ++j) {
      for (unsigned int i = 0; i < at.free.local.size(); ++i)
        C(at.free.global[i], at.controlled.global[j]) += K(at.free.local[i], at.controlled.local[j]);
      for (unsigned int i = 0; i < at.controlled.local.size(); ++i)
        K_cc(at.controlled.global[i], at.controlled.global[j]) += K(at.controlled.local[i], at.controlled.local[j]);
    }
  }
  Eigen::MatrixXd C, K_cc;
};

/// The program that a user would first write: every cell integrated, all unknowns in one sparse matrix, one solve for
/// each case.
Result solve_by_umfpack(Discretisation& plate, bool stresses, Phases& phases) {
  phases.begin("integrate");
  plate.number_rows();
  DynamicSparsityPattern entries(plate.n_rows);
  for (const auto& cell : plate.dofs.active_cell_iterators()) {
    auto rows = CellPlaces(plate, cell).free.global;
    std::sort(rows.begin(), rows.end());
    for (const auto row : rows) entries.add_entries(row, rows.begin(), rows.end(), true);
  }
  SparsityPattern pattern;
  pattern.copy_from(entries);
  SparseMatrix<double> K(pattern);
  Controlled controlled(plate);
  Integrator integrate(plate.mapping, plate.fe);
  for (const auto& cell : plate.dofs.active_cell_iterators()) {
    const auto K_cell = integrate(cell);
    const CellPlaces at(plate, cell);
    FullMatrix<double> K_free(at.free.local.size());
    K_free.extract_submatrix_from(K_cell, at.free.local, at.free.local);
    K.add(at.free.global, K_free);
    controlled.add(K_cell, at);
  }
  phases.begin("factorise");
  SparseDirectUMFPACK inverse;
  inverse.factorize(K);
  phases.begin("solve");
  Result result{controlled.K_cc, {}};
  Eigen::MatrixXd U(controlled.C.rows(), controlled.C.cols());
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    Vector<double> load(controlled.C.col(j).begin(), controlled.C.col(j).end());
    inverse.solve(load);
    U.col(j) = -Eigen::Map<const Eigen::VectorXd>(load.begin(), U.rows());
    result.S.col(j) += controlled.C.transpose() * U.col(j);
  }
  if (stresses) {
    phases.begin("stresses");
    result.hoop = hoop_stress(plate, U);
  }
  phases.end();
  return result;
}

/// At its best: the cells of one square stand for those of all, their insides are condensed, the rest is factorised
/// by CHOLMOD and solved for all cases at once.
Result solve_by_condensation(Discretisation& plate, bool stresses, Phases& phases) {
  phases.begin("integrate");
  plate.leave_out_insides();
  plate.number_rows();
  Controlled controlled(plate);
  Integrator integrate(plate.mapping, plate.fe);
  std::vector<FullMatrix<double>> square;
  std::vector<Eigen::MatrixXd> insides;
  std::vector<Eigen::Triplet<double>> lower;
  for (const auto& cell : plate.dofs.active_cell_iterators()) {
    if (square.size() < plate.panel.cells_per_square()) {
      square.push_back(integrate(cell));
      insides.push_back(condense(square.back(), plate.fe.get_first_quad_index(), plate.fe.n_dofs_per_cell()));
    }
    const auto& K_cell = square[cell->active_cell_index() % square.size()];
    const CellPlaces at(plate, cell);
    const auto& [local, row] = at.free;
    for (unsigned int i = 0; i < row.size(); ++i)
      for (unsigned int j = 0; j < row.size(); ++j)
        if (row[i] >= row[j]) lower.emplace_back(row[i], row[j], K_cell(local[i], local[j]));
    controlled.add(K_cell, at);
  }
  Eigen::SparseMatrix<double> K(plate.n_rows, plate.n_rows);
  K.setFromTriplets(lower.begin(), lower.end());
  phases.begin("factorise");
  const Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> inverse(K);
  phases.begin("solve");
  const Eigen::MatrixXd U = -inverse.solve(controlled.C);
  Result result{controlled.K_cc + controlled.C.transpose() * U, {}};
  if (stresses) {
    phases.begin("stresses");
    result.hoop = hoop_stress(plate, insides, U);
  }
  phases.end();
  return result;
}

std::string list(const Eigen::RowVectorXd& values) {
  return fmt::format("[{}]", fmt::join(values.begin(), values.end(), ", "));
}

std::string list_of_rows(const Eigen::MatrixXd& matrix) {
  std::vector<std::string> rows;
  for (const auto& row : matrix.rowwise()) rows.push_back(list(row));
  return fmt::format("[{}]", fmt::join(rows, ", "));
}

/// The member "rim": angles in degrees, and the hoop stresses of the first hole there in each case.
std::string rim_json(const Eigen::MatrixXd& hoop) {
  if (hoop.size() == 0) return "";
  const Eigen::RowVectorXd angle = Eigen::RowVectorXd::LinSpaced(n_angles, 0, 360 - degrees_between);
  return fmt::format(",\n \"rim\": {{\"angle\": {}, \"hoop\": {}}}", list(angle),
                     list_of_rows(hoop.topRows(n_angles).transpose()));
}

/// Throws std::invalid_argument.
unsigned int number(const char* text, unsigned int least, unsigned int most) {
  unsigned int value = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), value);
  if (error != std::errc() || *end != '\0' || value < least || value > most)
    throw std::invalid_argument(fmt::format("'{}' is not a number in {}..{}", text, least, most));
  return value;
}

void run(int n_words, char** words) {
  const Panel panel{number(words[1], 1, 1000), number(words[2], 1, 1000), number(words[4], 0, 20)};
  const unsigned int p = number(words[3], 1, 16);
  const std::string solver = words[5];
  if (solver != "umfpack" && solver != "condensed")
    throw std::invalid_argument(fmt::format("'{}' is not a solver; allowed: umfpack, condensed", solver));
  const bool stresses = n_words == 7;
  if (stresses && std::strcmp(words[6], "stresses") != 0)
    throw std::invalid_argument(fmt::format("'{}' is not an output; allowed: stresses", words[6]));
  MultithreadInfo::set_thread_limit(1);
  Phases phases;
  phases.begin("mesh");
  Discretisation plate(panel, p);
  const auto [S, hoop] =
      solver == "umfpack" ? solve_by_umfpack(plate, stresses, phases) : solve_by_condensation(plate, stresses, phases);
  fmt::print(R"({{"program": "deal.II {}", "solver": "{}", "nx": {}, "ny": {}, "rings": {}, "p": {}, "unknowns": {},)"
             "\n \"seconds\": {},\n \"S\": {}{}}}\n",
             DEAL_II_PACKAGE_VERSION, solver, panel.nx, panel.ny, panel.rings, p, plate.n_unknowns, phases.json(),
             list_of_rows(S), rim_json(hoop));
}

}  // namespace
}  // namespace fastjoint::peer

int main(int argc, char** argv) {
  fastjoint::linalg::take_better_kernels(argv);  // those of our programs
  try {
    if (argc != 6 && argc != 7) throw std::invalid_argument("five or six words are needed");
    fastjoint::peer::run(argc, argv);
    return 0;
  } catch (const std::invalid_argument& wrong) {
    std::cerr << "peer_dealii: error: " << wrong.what()
              << "\nusage: peer_dealii NX NY P RINGS umfpack|condensed [stresses]\n";
    return 2;
  } catch (const std::exception& failure) {
    std::cerr << "peer_dealii: error: " << failure.what() << "\n";
    return 1;
  }
}
