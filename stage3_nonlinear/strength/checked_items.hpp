// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "common/columns/column.hpp"
#include "common/infinite.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {

/// Results of a joint and of its plates at increments, from which strength is judged.
struct JointColumns {
  const columns::Columns* joint;
  std::vector<const columns::Columns*> plates;
};

/// Applied load and allowable at one increment, with the numbers that the allowable follows from.
struct Applied {
  double applied = 0, allowable = infinite;  ///< applied is not finite where it is not known
  std::string inputs{};
  double edge_ratio = infinite;
  double direction = infinite;  ///< degrees
};

/// What a check asks of one hole or one shear plane.
struct CheckedItem {
  const CheckScene* check;
  std::string of, formula, unit;
  std::function<Applied(const JointColumns&, Index step)> at;
  bool is_known = true;                            ///< false if it is not at any increment
  const char* unknown = "its value is not known";  ///< why that may be

  /// allowable / (FS FF applied) - 1; infinite where nothing is applied.
  [[nodiscard]] double margin(const Applied& now) const;
};

/// Items that checks leave out: check by check those of which it is not made, then those of some increments alone.
class LeftOut {
 public:
  void add(const CheckScene& check, const std::string& reason, const std::string& item,
           bool at_some_increments = false) {
    items_[{&check, at_some_increments, reason}].push_back(item);
  }
  /// A warning for each check and reason.
  [[nodiscard]] std::vector<program::Warning> warnings(const JointScene& scene) const;

 private:
  std::map<std::tuple<const CheckScene*, bool, std::string>, std::vector<std::string>> items_;
};

/// All that the checks of a joint ask, in their order.
struct CheckedItems {
  std::vector<CheckedItem> items;
  LeftOut left_out;  ///< holes for which a check cannot be made
};

/// Throws InputError if a check names what is not there, or needs stresses or an edge distance that are not known.
/// @param scene, joint Outlive the items. @param parameters Its gaps are used.
[[nodiscard]] CheckedItems checked_items(const JointScene& scene, const JointModel& joint,
                                         const Parameters& parameters);

}  // namespace fastjoint::stage3
