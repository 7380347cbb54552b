// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

/// JOINT.json with the values of a sample for the variables of a study. Only laws, fasteners and loads with variables
/// are read again. It must be used by one thread at a time.
class SampledJoint {
 public:
  /// @param scene That of the unchanged joint.
  SampledJoint(const input::Document& joint, const StudyScene& study, JointScene scene);

  /// The joint's scene with the values of all variables. Throws InputError where one is not allowed.
  const JointScene& scene(const std::vector<double>& values);
  /// The text of that JOINT.json for a file at a path, with the paths in it relative to there.
  [[nodiscard]] std::string text(const std::vector<double>& values, const std::string& path);

 private:
  void put(const std::vector<double>& values);
  /// A number of JOINT.json that a variable sets, and its original value.
  struct Target {
    nlohmann::json* number;
    double before;
    bool is_integer;
    Use use;
    std::size_t variable;
  };
  std::shared_ptr<nlohmann::json> root_;
  input::Document document_;
  std::string study_;  ///< file, for messages
  std::vector<Target> targets_;
  std::set<std::vector<std::string>> items_;  ///< with variables, by the parts of their pointers
  JointScene scene_;
};

}  // namespace fastjoint::stage3
