// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"

namespace fastjoint::stage3 {

/// JOINT.json with the values of a sample at the places that a study varies. Only laws, fasteners and loads with such
/// places are read again. One thread uses it at a time.
class SampledJoint {
 public:
  /// @param scene Of the joint as it stands.
  SampledJoint(const input::Document& joint, const StudyScene& study, JointScene scene);

  /// The joint's scene with the values of all variables. Throws InputError where one is not allowed.
  const JointScene& scene(const std::vector<double>& values);
  /// The text of that JOINT.json at a path, from where its files are found.
  [[nodiscard]] std::string text(const std::vector<double>& values, const std::string& path);

 private:
  void put(const std::vector<double>& values);
  /// Number of JOINT.json that a variable sets, and what it is there.
  struct Target {
    nlohmann::json* number;
    double before;
    bool is_integer;
  };
  std::shared_ptr<nlohmann::json> root_;
  input::Document document_;
  std::vector<Use> use_;
  std::vector<std::vector<Target>> targets_;  ///< of each variable
  SceneParts parts_;
  JointScene scene_;
};

}  // namespace fastjoint::stage3
