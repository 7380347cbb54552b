// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "stage3_nonlinear/interfaces/interface.hpp"
#include "stage3_nonlinear/interfaces/plane_memory.hpp"
#include "stage3_nonlinear/laws/law.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Law of a shear plane as a map from its contact coordinate c, a vector in force units with one entry for each
/// direction of the joint's discs: F and delta are along c, with the magnitudes of the law at |c|. With one direction
/// the law is odd; with two the clearance is a circle.
struct Contact {
  LawPointer law;
  double clearance = 0;    ///< length
  double stiffness = 1;    ///< k, force / length: that of the plates at this plane, so that F and k delta are alike
  bool one_sided = false;  ///< open for every c < 0; one direction only

  /// True if the plane is one-sided and open at c, shape (a).
  [[nodiscard]] bool is_pulled_open(const VectorXd& c) const { return one_sided && c[0] < 0; }
};

/// A hole of a fastener with friction, in one of the joint's directions, with the friction columns of the interface.
struct FrictionHole {
  Index hole;  ///< of the fastener
  Index direction;
  std::array<FrictionCase, 2> sides;  ///< by Side, with the columns of the interface
  Index disc;                         ///< column of the force on the disc along the direction
  std::optional<Index> other_disc;    ///< column of that along the other direction, if there are two
};

/// A fastener through its holes: the laws of its shear planes, and the cosine friction on the rims, which follows from
/// the bearing forces (docs/theory.md, sections 6.5 and 7.4).
///
/// The rows are the planes, directions inner. In each hole bearing and friction together transfer the load of the
/// plane, so that a fastener with different friction in its holes is in equilibrium.
class FastenerInterface : public Interface {
 public:
  /// Friction of a hole with one side bearing, per unit of the law's force there.
  struct HoleFriction {
    double peak = 0;       ///< stress Lambda of the case, 1 / length^2
    double resultant = 0;  ///< force of friction on the rim
    double bearing = 1;    ///< force of bearing on the rim; its difference from 1 is a force on the disc in Lambda
    double across = 0;     ///< force of the disc along the other axis

    /// Force of friction over that of bearing.
    [[nodiscard]] double friction_ratio() const { return resultant / bearing; }
  };
  /// Indices and friction of the fastener in a joint.
  struct Place {
    Index first_plane = 0, first_hole = 0;  ///< counted over the whole joint
    Index n_directions = 1;
    bool law_includes_friction = false;          ///< the laws give the transferred load, not the bearing force alone
    std::vector<double> mu{};                    ///< (h) of each hole
    std::vector<FrictionHole> friction_holes{};  ///< of each hole, directions inner; empty without friction
    Index n_columns = 0;                         ///< of friction
  };

  FastenerInterface(std::vector<Contact> planes, Place place);

  [[nodiscard]] Index size() const override { return std::ssize(planes_) * place_.n_directions; }
  [[nodiscard]] Index n_friction() const override { return place_.n_columns; }
  [[nodiscard]] Response respond(const VectorXd& c, const History& history) const override;
  [[nodiscard]] History commit(const VectorXd& c, const History& history) const override;
  [[nodiscard]] std::vector<PlaneMemory> memories(const History& history) const override;
  void add_small_stiffness(double small, Response& response) const override;
  [[nodiscard]] MatrixXd friction_by_force(const VectorXd& F) const override;
  [[nodiscard]] std::vector<std::vector<Corner>> corners() const override;
  [[nodiscard]] double position(const VectorXd& c, Index entry) const override;
  [[nodiscard]] VectorXd slope(const VectorXd& c, Index entry) const override;
  [[nodiscard]] bool is_one_sided(Index entry) const override { return planes_[entry].one_sided; }
  [[nodiscard]] VectorXd coordinates(const VectorXd& F) const override;
  [[nodiscard]] VectorXd transferred(const VectorXd& F, Index side) const override;
  [[nodiscard]] std::vector<Change> changes(const VectorXd& c, const Response& response) const override;

 private:
  [[nodiscard]] Index n_holes() const { return std::ssize(place_.mu); }
  /// The law's force on a plate in a hole along a direction.
  [[nodiscard]] double bearing(const VectorXd& F, Index hole, Index direction) const;
  [[nodiscard]] VectorXd friction(const VectorXd& F) const;
  /// Contribution of the hole `of` to the mean ratio of friction to bearing over the holes, if `hole` bears on `side`.
  /// The two holes of a single plane bear on opposite sides. With several planes each hole may bear on either side, and
  /// the mean over its sides counts.
  [[nodiscard]] double part_of_mean_ratio(Index of, Index hole, Index direction, Side side) const;
  /// Scales bearing and friction of each hole so that the holes of the fastener are in equilibrium.
  void balance();
  /// True if the hole has cosine friction; a rim of contact has none, whatever its coefficient.
  [[nodiscard]] bool has_case(Index hole) const;
  /// Index in Place::friction_holes, or -1.
  [[nodiscard]] Index friction_at(Index hole, Index direction) const {
    return place_.friction_holes.empty() ? -1 : hole * place_.n_directions + direction;
  }
  void add_law_changes(const VectorXd& c, const MatrixXd& by_force, std::vector<Change>& result) const;
  [[nodiscard]] Change change_by_mu(Index hole, const VectorXd& F) const;

  /// Sliders of a plane's branches in a history.
  [[nodiscard]] std::vector<Slider> sliders(const History& history, Index plane) const;
  /// State of a plane that remembers something; none of a plane whose law is elastic or whose sliders have not moved.
  [[nodiscard]] std::optional<RememberedState> remembered_state(const VectorXd& c, const History& history,
                                                                Index plane) const;

  /// The state at the coordinates of a plane, (a), from its sliders before; open where a one-sided plane would pull.
  [[nodiscard]] RememberedState state_from(const std::vector<Slider>& before, const VectorXd& c, Index plane) const;

  std::vector<Contact> planes_;
  std::vector<std::vector<MemoryBranch>> branches_;  ///< of each plane
  Place place_;
  std::vector<std::array<HoleFriction, 2>> sides_;  ///< of each of Place::friction_holes
};

}  // namespace fastjoint::stage3
