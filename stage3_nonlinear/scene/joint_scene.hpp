// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

namespace fastjoint::stage3 {

/// Name "plate:name" of the input and its place there, "FILE: POINTER", for messages.
struct Reference {
  std::string plate, name, where;
};

struct PlateScene {
  std::string name;
  std::string file;  ///< path of its MATRICES.h5, relative to the current folder
  std::string where;
  std::string digest{};  ///< that the file must have; empty: any
};

struct LawScene {
  LawPointer law;
  bool one_sided = false;
};

/// Last word of "between" for a body that does not move; no plate has this name.
inline constexpr const char* ground_name = "ground";

/// A fastener through h holes in their order along its axis: n shear planes, each between neighbours, the last between
/// the last hole and the ground if the fastener is held there.
struct FastenerScene {
  std::string id;
  std::vector<Reference> between;  ///< (h) "plate:hole"
  bool grounded = false;
  std::vector<std::string> law;   ///< (n) keys of JointScene::laws
  std::vector<double> clearance;  ///< (n) radial gap, length
  std::vector<double> gap{};  ///< (h) radial, in holes whose springs push but do not pull, length; none if not given
  std::optional<double> diameter{};     ///< of the fastener, instead of gaps, length
  std::vector<double> hole_diameter{};  ///< (h) length; none: those of the sheets' matrices
  std::vector<double> friction;         ///< (h) mu in each hole
  bool law_includes_friction = false;
  std::string where;

  /// Place of what gives the gaps.
  [[nodiscard]] std::string where_gap() const { return where + (diameter ? "/diameter" : "/gap"); }
};

struct LoadScene {
  Reference external;  ///< "plate:external"
  double value = 0;    ///< at load factor 1: force, or length
  bool is_displacement = false;
};

/// First guesses of Bortman & Szabo, section 6.1.
enum class Guess { rigid, linear, equal };

struct InitialScene {
  Guess guess = Guess::linear;
  std::optional<double> stiffness;  ///< of {"linear": K}, force / length
};

enum class Method {
  fitting,  ///< unless the input says otherwise: by the number of unknowns (iterative_method)
  hybridsj,
  damped_newton,
};

/// Values of "method" in JOINT.json, in the order of Method from hybridsj on.
inline const std::vector<std::string> method_names{"hybridsj", "damped newton"};

struct SolverScene {
  Method method = Method::fitting;
  double tolerance = 1e-10;  ///< largest residual, relative to the largest force of the increment
  int max_iterations = 200;  ///< of one try
};

/// What solves the increments first: unless the input says which, hybridsj up to the number of unknowns beyond which
/// damped Newton takes less time, since GSL factorises without blocks (docs/solvers.md).
[[nodiscard]] inline Method iterative_method(Method method, std::ptrdiff_t n_unknowns) {
  constexpr std::ptrdiff_t most_for_hybridsj = 40;
  if (method == Method::hybridsj || method == Method::damped_newton) return method;
  return n_unknowns <= most_for_hybridsj ? Method::hybridsj : Method::damped_newton;
}

/// JOINT.json as it stands (schemas/joint.schema.json).
struct JointScene {
  std::string file, name;
  std::optional<Units> units;
  std::vector<PlateScene> plates;
  std::map<std::string, LawScene> laws;
  std::vector<FastenerScene> fasteners;
  std::vector<LoadScene> loads;
  std::vector<double> load_factors{1};  ///< one per increment; none: increments at every event (follow_events)
  InitialScene initial;
  SolverScene solver;
  std::vector<program::Warning> warnings;

  /// Load factors that are asked for: of increments at every event the whole load, since they are those on the way.
  [[nodiscard]] std::vector<double> wanted_load_factors() const {
    return load_factors.empty() ? std::vector{1.0} : load_factors;
  }
};

/// Reads types and ranges strictly and checks what one file alone can tell: plates that are named exist and are held,
/// ids and loads stand once, each hole has one fastener, which goes through each plate once. Throws InputError.
[[nodiscard]] JointScene read_joint_scene(const input::Document& document);

/// Laws, fasteners and loads of JOINT.json.
struct SceneParts {
  std::set<std::string> laws;
  std::set<std::size_t> fasteners, loads;
};

/// Reads parts of a scene again from a document in which numbers of theirs alone have changed. Throws InputError.
void read_again(const input::Document& document, const SceneParts& parts, JointScene& scene);

/// Throws InputError "WHERE: FOUND; allowed: ALLOWED".
[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& allowed);

}  // namespace fastjoint::stage3
