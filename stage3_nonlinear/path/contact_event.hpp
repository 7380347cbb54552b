// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/contact.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Kind of a corner of a plane's curve: before the rim bears, where it begins to, after.
enum class CornerKind { slip, contact, yield };

/// Place on a plane's curve at which something happens to the fastener.
struct Corner {
  double at;  ///< contact coordinate, or its amount if the plane bears both ways; >= 0, force
  CornerKind kind;
};

/// Passing of a corner by a plane, away from the origin or back.
struct ContactEvent {
  Eigen::Index plane;
  CornerKind kind;
  bool back;

  bool operator==(const ContactEvent&) const = default;
};

/// Corners of the planes of a joint, and the events between its states.
class ContactCorners {
 public:
  explicit ContactCorners(const std::vector<Contact>& contacts);

  /// Corners of a plane, ascending: where its rim begins to bear, and those of a law that is linear between them.
  [[nodiscard]] const std::vector<Corner>& of(Eigen::Index plane) const { return corners_[plane]; }
  /// Number of corners that each plane has passed, negative on the negative side, (n).
  ///
  /// @param c Contact coordinates, shape (n a), force.
  [[nodiscard]] Eigen::VectorXi passed(const Eigen::VectorXd& c) const;
  /// Events on the way from one vector of passed() to another.
  [[nodiscard]] std::vector<ContactEvent> between(const Eigen::VectorXi& before, const Eigen::VectorXi& after) const;
  /// Events at c, on the corners themselves, coming from `before`.
  [[nodiscard]] std::vector<ContactEvent> at(const Eigen::VectorXd& before, const Eigen::VectorXd& c) const;
  /// Distance within which c is on a corner at `at`, force.
  [[nodiscard]] static double nearness(const Eigen::VectorXd& c, double at);

 private:
  [[nodiscard]] Eigen::VectorXd positions(const Eigen::VectorXd& c) const;
  std::vector<std::vector<Corner>> corners_;
  std::vector<bool> one_sided_;
};

/// "1, 3 close; 2 yields", empty if nothing happens.
[[nodiscard]] std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events);

}  // namespace fastjoint::stage3
