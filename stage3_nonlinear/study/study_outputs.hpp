// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/strength/checked_items.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

/// The quantities that are outputs of studies.
[[nodiscard]] std::vector<columns::Output> all_outputs();

/// Numbers of one kind among those of a sample: those of a quantity at all its things.
struct OutputKind {
  columns::Output output;
  columns::Dimension dimension;
  std::vector<std::string> of{};  ///< names of the things
  Index first = 0;                ///< column of the first among the numbers of a sample
  std::vector<double> limit{};    ///< of each, whose exceedance is counted; infinite without one
};

/// The numbers that a study takes from each sample: the quantities that are outputs of studies and that it asks for,
/// and of checks the utilisation FS FF applied / allowable, which is above 1 where the margin is negative.
class StudyOutputs {
 public:
  /// @param scene The joint's, whose checks are asked; outlives this.
  StudyOutputs(const JointModel& joint, const Parameters& parameters, const JointScene& scene, const StudyScene& study);

  [[nodiscard]] const std::vector<OutputKind>& kinds() const { return kinds_; }
  /// Items of checks without a number.
  [[nodiscard]] const LeftOut& left_out() const { return left_out_; }
  /// How many numbers.
  [[nodiscard]] Index size() const { return size_; }
  /// True if some follow from the stresses of plates: those of holes and of checks.
  [[nodiscard]] bool need_stresses() const;
  /// True if some follow from secondary bending.
  [[nodiscard]] bool need_bending() const;
  /// The numbers of one load case; a utilisation that is not known is infinite.
  [[nodiscard]] VectorXd numbers(const JointAt& at, const std::string& case_name) const;
  /// Takes the numbers of a case into the envelope of those before.
  void take(const VectorXd& its, VectorXd& all) const;

 private:
  /// Places of the numbers of a quantity: in the values of its group, and among those of a sample.
  struct Source {
    Index plate, group, column;  ///< -1 for the joint
    Index kind;                  ///< among kinds_
    std::vector<Index> rows;     ///< of the values of the group, which are taken
    Index first;                 ///< of the kind's numbers
  };
  /// Adds what is asked for of groups. @param names Of things of a kind; empty for one whose numbers are not known.
  template <class At, class Names>
  void add(const std::vector<columns::Group<At>>& groups, Index plate, const StudyScene& study, Names names);
  void add_checks(const JointModel& joint, const Parameters& parameters, const JointScene& scene,
                  const StudyScene& study);
  /// Utilisation of each item of the checks.
  [[nodiscard]] VectorXd utilisations(const JointAt& at, const std::string& case_name) const;

  std::vector<OutputKind> kinds_{};
  std::vector<Source> sources_{};
  std::vector<CheckedItem> items_{};
  LeftOut left_out_{};
  std::vector<std::vector<PlateGroup>> checked_{};  ///< of each plate, those that checks ask: of its holes and discs
  std::vector<JointGroup> of_joint_;
  std::vector<std::vector<PlateGroup>> of_plates_{};
  Index size_ = 0;
};

}  // namespace fastjoint::stage3
