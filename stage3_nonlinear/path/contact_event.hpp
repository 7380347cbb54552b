// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/contact.hpp"
#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// What a corner of a plane's curve means: before the rim bears, where it begins to, after.
enum class Corner { slip, contact, yield };

/// A place on a plane's curve at which something happens to the fastener.
struct Mark {
  double at;  ///< contact coordinate, or its amount if the plane bears both ways; >= 0, force
  Corner corner;
};

/// A plane passes a mark, away from the origin or back.
struct ContactEvent {
  Eigen::Index plane;
  Corner corner;
  bool back;

  bool operator==(const ContactEvent&) const = default;
};

/// What can happen to the planes of a joint, and what did.
class ContactMarks {
 public:
  explicit ContactMarks(const std::vector<Contact>& contacts);

  /// Marks of a plane, ascending: where its rim begins to bear, and the corners of a law that is linear between them.
  [[nodiscard]] const std::vector<Mark>& of(Eigen::Index plane) const { return marks_[plane]; }
  /// How many marks each plane has reached, negative on the negative side, (n).
  ///
  /// @param c Contact coordinates, shape (n a), force.
  [[nodiscard]] Eigen::VectorXi stages(const Eigen::VectorXd& c) const;
  /// What happens on the way from one vector of stages to another.
  [[nodiscard]] std::vector<ContactEvent> between(const Eigen::VectorXi& before, const Eigen::VectorXi& after) const;
  /// What happens at c, on the marks themselves, coming from `before`.
  [[nodiscard]] std::vector<ContactEvent> at(const Eigen::VectorXd& before, const Eigen::VectorXd& c) const;
  /// Distances within which c is on a mark at `at`, force.
  [[nodiscard]] static double nearness(const Eigen::VectorXd& c, double at);

 private:
  [[nodiscard]] Eigen::VectorXd positions(const Eigen::VectorXd& c) const;
  std::vector<std::vector<Mark>> marks_;
  std::vector<bool> one_sided_;
};

/// "1, 3 close; 2 yields", empty if nothing happens.
[[nodiscard]] std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events);

}  // namespace fastjoint::stage3
