// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/sampled_joint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/errors.hpp"

namespace fastjoint::stage3 {
namespace {

using nlohmann::json;

/// Converts the path of a file in a document to one relative to the folder of another document.
void turn_path(json& path, const std::filesystem::path& from, const std::filesystem::path& to) {
  const std::filesystem::path file = path.get<std::string>();
  if (file.is_absolute()) return;
  path = std::filesystem::proximate(from / file, to.empty() ? "." : to).string();
}

}  // namespace

SampledJoint::SampledJoint(const input::Document& joint, const StudyScene& study, JointScene scene)
    : root_(std::make_shared<json>(*joint.root)),
      document_{joint.file, joint.text, root_},
      study_(study.file),
      scene_(std::move(scene)) {
  for (std::size_t i = 0; i < study.variables.size(); ++i)
    for (const auto& place : study.variables[i].places) {
      const json::json_pointer pointer(place);
      const bool is_there = root_->contains(pointer);
      json& number = (*root_)[pointer];
      targets_.push_back({&number, is_there ? number.get<double>() : 0, is_there && number.is_number_integer(),
                          study.variables[i].use, i});
      auto parts = parts_of_pointer(place);
      parts.resize(parts[0] == "cases" ? 4 : 2);
      items_.insert(std::move(parts));
    }
}

void SampledJoint::put(const std::vector<double>& values) {
  for (const auto& [number, before, is_integer, use, variable] : targets_) {
    const double drawn = values[variable];
    const double value = use == Use::value ? drawn : use == Use::factor ? before * drawn : before + drawn;
    if (!std::isfinite(value))
      throw InputError(study_ + ": a number of the sample is too large; allowed: finite numbers");
    constexpr double max_integer = 1e15;
    if (is_integer && value == std::floor(value) && std::abs(value) < max_integer)
      *number = static_cast<std::int64_t>(value);
    else
      *number = value;
  }
}

const JointScene& SampledJoint::scene(const std::vector<double>& values) {
  put(values);
  try {
    read_again(document_, items_, scene_);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: a sample is not allowed: {}", study_, e.what()));
  }
  return scene_;
}

std::string SampledJoint::text(const std::vector<double>& values, const std::string& path) {
  put(values);
  json result = *root_;
  const auto from = std::filesystem::path(document_.file).parent_path(), to = std::filesystem::path(path).parent_path();
  for (auto& plate : result["plates"]) turn_path(plate.is_object() ? plate["file"] : plate, from, to);
  for (auto& law : result["laws"])
    if (law.contains("file")) turn_path(law["file"], from, to);
  return result.dump(2) + "\n";
}

}  // namespace fastjoint::stage3
