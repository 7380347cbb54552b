// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/input/value.hpp"
#include "common/program/warning.hpp"
#include "common/units.hpp"
#include "stage3_nonlinear/laws/law.hpp"
#include "stage3_nonlinear/scene/bending_scene.hpp"
#include "stage3_nonlinear/scene/margin_scene.hpp"
#include "stage3_nonlinear/scene/solver_scene.hpp"

namespace fastjoint::stage3 {

/// A name "plate:name" in the input, and its location, "FILE: POINTER", for messages.
struct Reference {
  std::string plate, name, where;
};

struct PlateScene {
  std::string name;
  std::string file;  ///< path of its MATRICES.h5, relative to the current folder
  std::string where;
  std::string digest{};  ///< required digest of the file; empty: any
};

struct LawScene {
  LawPointer law;
  bool one_sided = false;
};

/// Last entry of "between" for a fixed body; no plate may have this name.
inline constexpr const char* ground_name = "ground";

/// A fastener through h holes in their order along its axis: n shear planes, each between neighbours, the last between
/// the last hole and the ground if the fastener is grounded.
struct FastenerScene {
  std::string id;
  std::vector<Reference> between;  ///< (h) "plate:hole"
  bool grounded = false;
  std::vector<std::string> law;      ///< (n) keys of JointScene::laws
  std::vector<double> clearance;     ///< (n) radial gap, length
  std::vector<double> gap{};         ///< (h) radial, in holes with compression-only springs, length; empty if not given
  std::optional<double> diameter{};  ///< of the fastener, instead of gaps, length
  std::vector<double> hole_diameter{};          ///< (h) length; empty: those of the sheets' matrices
  std::vector<double> friction;                 ///< (h) mu in each hole
  std::vector<std::array<double, 2>> offset{};  ///< (h) of each hole's centre in its free sheet, x and y; length
  std::optional<double> expansion{};            ///< of the shank per degree; none: as its sheets
  bool law_includes_friction = false;
  std::string where;

  /// Location of the input from which the gaps follow.
  [[nodiscard]] std::string where_gap() const { return where + (diameter ? "/diameter" : "/gap"); }
};

struct LoadScene {
  Reference external;  ///< "plate:external"
  double value = 0;    ///< at load factor 1: force, length, or moment
  bool is_displacement = false, is_moment = false;
  std::vector<Reference> tied{};  ///< externals that move with it; the force is that on all of them
};

/// A load case: loads and the increments in which they grow.
struct CaseScene {
  std::string name;  ///< empty: the only one of a joint without "cases"
  std::vector<LoadScene> loads;
  std::vector<double> load_factors{1};          ///< one per increment; empty: increments at every event (follow_events)
  std::map<std::string, double> temperature{};  ///< change of plates since the assembly, degrees; others: 0
  std::optional<double> fastener_temperature{};  ///< none: the mean of a fastener's sheets
  std::optional<std::size_t> after{};  ///< the case whose last state it starts from, to whose loads its own are added
  std::string where{}, where_loads{};  ///< places of the case and of its loads, for messages

  /// Externals with a given displacement, "plate:external", and ties, "plate:external to plate:external": what the
  /// condensed system depends on.
  [[nodiscard]] std::set<std::string> held() const;
  /// The requested load factors; the full load if increments are at every event.
  [[nodiscard]] std::vector<double> wanted_load_factors() const {
    return load_factors.empty() ? std::vector{1.0} : load_factors;
  }
};

/// The contents of JOINT.json (schemas/joint.schema.json).
struct JointScene {
  std::string file, name;
  std::optional<Units> units;
  std::vector<PlateScene> plates;
  std::map<std::string, LawScene> laws;
  std::vector<FastenerScene> fasteners;
  std::vector<CaseScene> cases;
  std::vector<CheckScene> checks{};  ///< of "margins"
  BendingScene bending{};
  InitialScene initial;
  SolverScene solver;
  std::vector<program::Warning> warnings;
};

/// Reads types and ranges strictly and makes all checks that need no other file: plates exist and have fasteners, ids
/// and loads are unique, each hole has one fastener, which goes through each plate once. Throws InputError.
[[nodiscard]] JointScene read_joint_scene(const input::Document& document);

/// Reads items of a scene again from a document in which only their numbers have changed. Throws InputError.
/// @param items Laws, fasteners and loads, each by the parts of its JSON pointer.
void read_again(const input::Document& document, const std::set<std::vector<std::string>>& items, JointScene& scene);

/// Throws InputError "WHERE: FOUND; allowed: ALLOWED".
[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& allowed);

}  // namespace fastjoint::stage3
