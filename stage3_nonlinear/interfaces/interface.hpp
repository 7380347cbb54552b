// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What an interface keeps of the path that has led to a state. No kind of today keeps anything: it is empty.
using History = VectorXd;

/// Answer of an interface to its n contact coordinates c, with derivatives by c.
struct Response {
  VectorXd F, delta;    ///< (n) forces between the bodies, and their relative displacements; force, length
  VectorXd Lambda;      ///< (t) amounts of what friction adds (FrictionColumn)
  MatrixXd dF, ddelta;  ///< (n, n), symmetric without friction; dimensionless, length / force
  MatrixXd dLambda;     ///< (t, n) per force
  Index spent = -1;     ///< a row past all that the interface can carry, if there is one
};

/// Kind of a corner: before the rim of a fastener bears, where it begins to, after; or of a rim of contact: where it
/// begins to touch its disc anywhere, and ceases to touch it all around.
enum class CornerKind { slip, contact, yield, touch, part };

/// Place at which something happens to an interface.
struct Corner {
  double at;  ///< Interface::position, or its amount where the interface bears both ways; >= 0, force
  CornerKind kind;
};

/// Kind of a number of the input.
enum class NumberKind { clearance, law, mu, rim_mu, gap };

/// Change of a response with a number of the input, c and the history being fixed.
struct Change {
  NumberKind kind;
  Index at;          ///< plane of a clearance or a law, hole of mu, rim of contact of the rest; of all of the joint
  Index number = 0;  ///< of a law
  VectorXd F, delta, Lambda;
};

/// What acts between bodies of a joint at some rows of its equations: it answers contact coordinates with forces and
/// displacements, and with amounts of friction on the bodies.
class Interface {
 public:
  virtual ~Interface() = default;

  /// Number n of its rows.
  [[nodiscard]] virtual Index size() const = 0;
  /// Number t of its friction columns.
  [[nodiscard]] virtual Index n_friction() const { return 0; }
  /// @param c Contact coordinates, (n), force.
  [[nodiscard]] virtual Response respond(const VectorXd& c, const History& history) const = 0;
  /// The history once the joint has come to rest at c.
  [[nodiscard]] virtual History commit(const VectorXd& /*c*/, const History& history) const { return history; }
  /// Gives a response whose slopes vanish a trace of stiffness (docs/theory.md, section 8.5).
  virtual void add_trace(double trace, Response& response) const = 0;
  /// Derivatives of Lambda by F, (t, n), where friction follows from the forces alone, on the sides that bear under F;
  /// empty if it does not.
  [[nodiscard]] virtual MatrixXd friction_by_force(const VectorXd& /*F*/) const { return {}; }
  /// Corners of each of its entries, ascending: a fastener has one entry for each plane, a rim of contact one for
  /// touching and one for parting.
  [[nodiscard]] virtual std::vector<std::vector<Corner>> corners() const = 0;
  /// Position of an entry between its corners, force, and its derivative by c, (n).
  [[nodiscard]] virtual double position(const VectorXd& c, Index entry) const = 0;
  [[nodiscard]] virtual VectorXd slope(const VectorXd& c, Index entry) const = 0;
  /// True if positions below zero are no mirror image of those above.
  [[nodiscard]] virtual bool is_one_sided(Index /*entry*/) const { return true; }
  /// Coordinates at which the forces are F, or about that, (n), force.
  [[nodiscard]] virtual VectorXd coordinates(const VectorXd& F) const = 0;
  /// Load that each shear plane passes on, friction included, by that of its first (0) or its second (1) hole, (n).
  [[nodiscard]] virtual VectorXd transferred(const VectorXd& F, Index /*side*/) const { return F; }
  /// Changes with all numbers that it knows.
  [[nodiscard]] virtual std::vector<Change> changes(const VectorXd& c, const Response& response) const = 0;
};

}  // namespace fastjoint::stage3
