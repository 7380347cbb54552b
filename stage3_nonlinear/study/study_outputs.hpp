// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/strength/checked_items.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

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
  StudyOutputs(const JointModel& joint, const JointScene& scene, const StudyScene& study);

  [[nodiscard]] const std::vector<OutputKind>& kinds() const { return kinds_; }
  /// How many numbers.
  [[nodiscard]] Index size() const { return size_; }
  /// The numbers of one load case; a utilisation that is not known is infinite.
  [[nodiscard]] VectorXd numbers(const JointAt& at, const std::string& case_name) const;
  /// Takes the numbers of a case into the envelope of those before.
  void take(const VectorXd& its, VectorXd& all) const;

 private:
  /// Where a quantity of a group goes.
  struct Source {
    Index column, kind;       ///< in the group; among kinds_
    std::vector<Index> rows;  ///< of the group, which are taken
    Index first = 0;          ///< column of the first number of a sample
    bool is_magnitude = false;
  };
  template <class At>
  struct Asked {
    columns::Group<At> group;
    Index plate;
    std::vector<Source> sources;
  };
  /// Adds what is asked for of a group. @param name Of a thing; empty for one whose numbers are not known.
  template <class At, class Name>
  void add(columns::Group<At> group, Index plate, const StudyScene& study, Name name, std::vector<Asked<At>>& all);

  void add_checks(const JointModel& joint, const JointScene& scene, const StudyScene& study);
  /// Utilisation of each item of the checks.
  [[nodiscard]] VectorXd utilisations(const JointAt& at, const std::string& case_name) const;

  std::vector<OutputKind> kinds_;
  std::vector<CheckedItem> items_;
  std::vector<Asked<JointAt>> of_joint_;
  std::vector<Asked<PlateAt>> of_plates_;
  Index size_ = 0;
};

}  // namespace fastjoint::stage3
