// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/interfaces/plane_memory.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Internal variables of an interface at a state of the path, those of its sliders; empty before its first increment,
/// and of one that remembers nothing.
using History = std::vector<Slider>;

/// Forces and displacements of an interface at its n contact coordinates c, with derivatives by c.
struct Response {
  VectorXd F, delta;    ///< (n) forces between the bodies, and their relative displacements; force, length
  VectorXd Lambda;      ///< (t) amplitudes of friction (FrictionColumn)
  MatrixXd dF, ddelta;  ///< (n, n), symmetric without friction; dimensionless, length / force
  MatrixXd dLambda;     ///< (t, n) per force
  Index failed = -1;    ///< a row past the limit load of its interface, or -1
};

/// Kind of a corner. Of a fastener: before its rim bears (slip), where it begins to bear (contact), after (yield). Of a
/// rim of contact: where it begins to touch its disc (touch), and where it loses full contact (part).
enum class CornerKind { slip, contact, yield, touch, part };

/// Position at which the branch of an interface changes.
struct Corner {
  double at;  ///< Interface::position, or its magnitude if the interface bears both ways; >= 0, force
  CornerKind kind;
};

/// What a shear plane remembers after an increment.
struct PlaneMemory {
  VectorXd set;            ///< (a) permanent set of its bearing, length
  double dissipated = 0;   ///< energy that slip and yield have taken so far, force x length
  VectorXd slip, yield{};  ///< (a) motion in the last increment, length; 0 or empty: none
};

/// Kind of an input parameter.
enum class NumberKind { clearance, law, mu, rim_mu, gap };

/// Derivative of a response by an input parameter at fixed c and history.
struct Change {
  NumberKind kind;
  Index at;          ///< plane of a clearance or law, hole of mu, or rim of contact, counted over the whole joint
  Index number = 0;  ///< which parameter of a law
  VectorXd F, delta, Lambda;
};

/// Unit vector along v; the first axis where v = 0.
[[nodiscard]] VectorXd along(const VectorXd& v);

/// Constitutive relation between bodies of a joint at some rows of its equations: it maps contact coordinates to
/// forces, relative displacements and amplitudes of friction.
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
  /// What each of its planes remembers; empty of an interface without planes.
  [[nodiscard]] virtual std::vector<PlaneMemory> memories(const History& /*history*/) const { return {}; }
  /// Adds a small stiffness where the slopes of a response vanish (docs/theory.md, section 8.5).
  /// @param small Over the reference stiffness.
  virtual void add_small_stiffness(double small, Response& response) const = 0;
  /// Derivatives of Lambda by F, (t, n), on the sides that bear under F, if friction depends only on the forces; else
  /// empty.
  [[nodiscard]] virtual MatrixXd friction_by_force(const VectorXd& /*F*/) const { return {}; }
  /// Corners of each of its entries, ascending: a fastener has one entry for each plane, a rim of contact one for
  /// touching and one for parting.
  [[nodiscard]] virtual std::vector<std::vector<Corner>> corners() const = 0;
  /// Position of an entry between its corners, force, and its derivative by c, (n).
  [[nodiscard]] virtual double position(const VectorXd& c, Index entry) const = 0;
  [[nodiscard]] virtual VectorXd slope(const VectorXd& c, Index entry) const = 0;
  /// True if the interface does not bear in both directions.
  [[nodiscard]] virtual bool is_one_sided(Index /*entry*/) const { return true; }
  /// Coordinates at which the forces are approximately F, (n), force.
  [[nodiscard]] virtual VectorXd coordinates(const VectorXd& F) const = 0;
  /// Load that each shear plane transfers, with the friction of its first (0) or its second (1) hole, (n).
  [[nodiscard]] virtual VectorXd transferred(const VectorXd& F, Index /*side*/) const { return F; }
  /// Derivatives by all input parameters of the interface.
  [[nodiscard]] virtual std::vector<Change> changes(const VectorXd& c, const Response& response) const = 0;
};

}  // namespace fastjoint::stage3
