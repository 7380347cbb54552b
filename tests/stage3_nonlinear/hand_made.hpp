// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/formats/plate_matrices.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::test {

/// Nearly exact equilibrium at every increment.
inline const stage3::PathOptions tight{{}, {.tolerance = 1e-13, .max_iterations = 500}};

/// A random number between two.
[[nodiscard]] double uniform(std::mt19937& random, double low, double high);

/// A spring between two unknowns of a plate (discs first, then externals), or from one to the ground.
struct Spring {
  int a, b;
  double k;
};
inline constexpr int ground = -1;

/// A plate made of springs, at p = 8: holes "1", "2", ..., externals "P", "Q" as far as asked for.
[[nodiscard]] formats::PlateMatrices spring_plate(int n_discs, int n_externals, const std::vector<Spring>& springs);

/// Discs in a row with springs k between neighbours; what holds and loads it is left to `more`.
[[nodiscard]] formats::PlateMatrices chain(int n_discs, int n_externals, double k, const std::vector<Spring>& more);

/// Gives every hole friction cases on both sides: random R, c and resultants of the size that real plates
/// have.
void add_friction(formats::PlateMatrices& plate, std::mt19937& random);

/// Makes the springs of a hole push but not pull: pressures of one wave, which no displacement of the plate presses on.
void add_contact(formats::PlateMatrices& plate, const std::string& hole, double radius);

/// Plate "a" pulled at its external "P" with `force`, plate "b" held or floating, fastener j through the
/// holes j of both.
struct Lap {
  formats::PlateMatrices a, b;
  double force = 1;
};

/// A joint made by hand, with the numbers of a run of it.
struct HandMade : stage3::JointModel {
  using At = std::pair<Eigen::Index, Eigen::Index>;  ///< plate, and external, traction or disc
  std::map<At, double> force, displacement;  ///< of externals; without a displacement they have a force, or none
  std::map<At, double> traction;             ///< force on a traction
  std::vector<stage3::LawPointer> law;       ///< of each plane
  std::vector<double> clearance;             ///< of each plane, length
  std::map<At, double> mu, gap;              ///< of holes; others 0

  [[nodiscard]] static At at(const stage3::HoleModel& hole) { return {hole.plate, hole.disc}; }
  void set_mu(stage3::HoleModel& hole, double value) {
    hole.has_friction = value != 0;
    mu[at(hole)] = value;
  }
  void remove_fasteners();
  /// All numbers of the run.
  [[nodiscard]] stage3::Parameters numbers() const;
};

/// Condenses the joint, and puts its numbers in.
[[nodiscard]] stage3::JointEquations make_equations(const HandMade& joint);

/// A joint of those two without files, all fasteners with this law.
[[nodiscard]] HandMade joint_of(const Lap& lap, const std::shared_ptr<const stage3::Law>& law);

/// Adds a fastener through these holes (plate, disc), into the ground if `grounded`, all its planes with one law.
void add_fastener(HandMade& joint, const std::vector<std::pair<Eigen::Index, Eigen::Index>>& holes,
                  const std::shared_ptr<const stage3::Law>& law, bool grounded = false);

/// Gives a fastener of `joint` friction mu on all its plates, from the friction cases of the plates.
void set_friction(HandMade& joint, Eigen::Index fastener, double mu);

/// Gives a hole a friction case of its own for a side that bears: the loads on the plate's unknowns and the force of
/// friction, both per unit bearing force and unit coefficient.
[[nodiscard]] stage3::FrictionCase add_case(stage3::PlateModel& plate, const stage3::HoleModel& hole, Eigen::Index d,
                                            stage3::Side side, const Eigen::VectorXd& load, double resultant);

/// Ranges of random joints.
struct RandomJoint {
  double least_n = 0.4;  ///< exponents from here to 1
  bool cubics = false;
  bool clearances = true;
  bool friction = false;
  bool one_sided = false;
  bool floating = false;   ///< plate b is held by the fasteners only
  bool piecewise = false;  ///< laws that are linear between corners
};

/// A lap joint of 1 to 12 fasteners with random stiffness, laws and gaps.
[[nodiscard]] HandMade random_joint(std::mt19937& random, const RandomJoint& kind);

/// Equations of planes without plates, each a fastener of its own, under a load q at load factor 1.
/// @param contacts With the stiffness of the plates themselves, which is replaced.
[[nodiscard]] stage3::JointEquations equations_of(const Eigen::MatrixXd& S_ud, const Eigen::VectorXd& q,
                                                  std::vector<stage3::Contact> contacts);

/// State of such planes, whose stiffness is that of their contacts.
[[nodiscard]] stage3::ContactState state_of(const std::vector<stage3::Contact>& contacts, const Eigen::VectorXd& c);

/// Forces of linear fasteners of stiffness k at load factor 1.
[[nodiscard]] Eigen::VectorXd linear_solution(const HandMade& joint, double k);

/// Displacements of all unknowns without friction at load factor 1.
[[nodiscard]] Eigen::VectorXd displacements_of(const HandMade& joint, const Eigen::VectorXd& delta);

/// The solution of a step.
[[nodiscard]] inline stage3::SolvedPoint point_of(const stage3::JointEquations& equations,
                                                  const stage3::PathStep& step) {
  return {equations, step.load_factor, step.c};
}

/// Derivatives of forces by kinds of numbers.
struct Sensitivity {
  Eigen::VectorXd load_factor;
  Eigen::MatrixXd clearance, law, mu, force, displacement, gap;
};
[[nodiscard]] inline Sensitivity sensitivity_at(const stage3::JointNumbers& numbers, const stage3::SolvedPoint& point) {
  const Eigen::MatrixXd all = sensitivity(state_slopes(numbers, point), point);
  const auto kinds = numbers.kinds();
  const auto by = [&](std::size_t kind) -> Eigen::MatrixXd { return all.middleCols(kinds[kind].first, kinds[kind].n); };
  return {by(0), by(1), by(2), by(3), by(4), by(5), by(6)};
}

/// A symmetric matrix with eigenvalues of order 1, all > 0, shape (n, n).
[[nodiscard]] Eigen::MatrixXd random_stiffness(std::mt19937& random, int n);

/// Writes a.h5 and b.h5 and a joint.json of joint_text(members); returns the path of the JSON.
[[nodiscard]] std::string write_joint(const TemporaryFolder& folder, const Lap& lap,
                                      const std::map<std::string, std::string>& members = {});

/// Two discs each: a pulled at P, b held at its left end; segments of stiffness 1000.
[[nodiscard]] Lap two_fastener_lap();

}  // namespace fastjoint::test
