// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/plate_solution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include "common/count.hpp"
#include "common/errors.hpp"

namespace fastjoint::formats {
namespace {

[[noreturn]] void fail(const std::string& file, const char* dataset, const std::string& found,
                       const std::string& expected) {
  throw FileError(fmt::format("{}:{}: {}, expected {}; run stage1_plate again", file, dataset, found, expected));
}

/// Rejects elements with a repeated node, nodes without an element, and arcs without an edge.
void check_mesh(const std::string& file, const pfem::Mesh& mesh, const pfem::Edges& edges) {
  std::vector<bool> used(mesh.n_nodes(), false);
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const auto quad = mesh.quads.col(element);
    if (std::set<int>(quad.begin(), quad.end()).size() < 4)
      fail(file, "mesh/quads", fmt::format("element {} has the nodes {}", element, fmt::join(quad, ", ")),
           "four different ones");
    for (const int node : quad) used[node] = true;
  }
  if (const auto unused = std::ranges::find(used, false); unused != used.end())
    fail(file, "mesh/quads", fmt::format("no element has node {}", unused - used.begin()), "each in an element");
  for (const auto& arc : mesh.arcs)
    if (edges.between(arc.a, arc.b) < 0)
      fail(file, "mesh/arc_nodes", fmt::format("holds {}, {}", arc.a, arc.b), "nodes that an edge joins");
}

/// Rejects a rim that differs from that of the mesh around the hole.
void check_rims(const std::string& file, const PlateSolution& a, const pfem::Edges& edges) {
  // Stage 1 gives all arcs of a rim the centre of the first: from each to hole and to nodes were three tolerances.
  constexpr double tolerance = 3 * rim::same_place;
  for (int hole = 0; hole < count_of(a.hole_rim); ++hole) {
    const rim::Rim& rim = a.hole_rim[hole];
    if (!(rim.sides == rim::find_rim(a.mesh, edges, rim.center, rim.radius, tolerance).sides))
      throw FileError(fmt::format(
          "{}:hole/rim: the sides of hole \"{}\" are not those arcs of the mesh that have its centre and its radius {}",
          file, a.hole_id[hole], rim.radius));
  }
}

/// Rejects plate unknowns that are not numbered in the order of the functions, u_x before u_y, as stage 1 does.
void check_unknowns(const std::string& file, const PlateSolution& a) {
  const int n = a.ndof[a.ndof.size() - 1];
  int next = 0;
  for (int function = 0; function < a.unknown.cols(); ++function)
    for (const int dof : a.unknown.col(function))
      if (dof >= 0 && dof != next++)
        fail(file, "unknown", fmt::format("holds {} in row {} instead of {}", dof, function, next - 1),
             fmt::format("each plate unknown from 0 to {} once, in this order", n - 1));
  if (next != n)
    fail(file, "unknown", fmt::format("holds {} plate unknowns", next), fmt::format("{}, as ndof has them", n));
}

/// Returns the directions of the discs of each hole. Rejects discs that are not in the order of the holes, then of the
/// points.
std::vector<std::vector<rim::Axis>> check_discs(const std::string& file, const PlateSolution& a) {
  std::vector<std::vector<rim::Axis>> of_hole;
  int end = 0;
  for (const auto& id : a.hole_id) {
    const int first = end;
    while (end < count_of(a.disc_hole) && a.disc_hole[end] == id) ++end;
    if (std::ranges::count(a.disc_hole, id) != end - first)
      throw FileError(
          fmt::format("{}:disc/hole: does not have the discs of hole \"{}\" one after the other, in the order "
                      "of the holes",
                      file, id));
    const auto names = std::span(a.disc_direction).subspan(first, end - first);
    if (std::ssize(std::set<std::string>(names.begin(), names.end())) != end - first)
      fail(file, "disc/direction", fmt::format("hole \"{}\" has {}", id, fmt::join(names, ", ")),
           "each direction once");
    std::ranges::transform(names, std::back_inserter(of_hole.emplace_back()), rim::axis_named);
  }
  const int first = end;
  for (int point = 0; point < count_of(a.points); ++point)
    if (a.points[point].disc != end++)
      fail(file, "point/disc", fmt::format("holds {}", a.points[point].disc),
           fmt::format("the discs after those of holes, from {} on, each once", first));
  if (end != count_of(a.disc_hole))
    fail(file, "disc/hole", fmt::format("names {} discs", a.disc_hole.size()),
         fmt::format("{}: those of holes, then one for each spring of a point", end));
  return of_hole;
}

/// Rejects rims in contact and friction cases that differ from those of the holes or are in another order.
void check_cases(const std::string& file, const PlateSolution& a,
                 const std::vector<std::vector<rim::Axis>>& directions) {
  std::vector<std::string> cases, expected;
  const auto place = [&](const auto& rim) { return index_of(a.hole_id, rim.hole); };
  const auto check_order = [&](const char* dataset, const auto& rims) {
    for (std::size_t i = 0; i < rims.size(); ++i)
      if (place(rims[i]) == count_of(a.hole_id) || (i > 0 && place(rims[i]) <= place(rims[i - 1])))
        fail(file, dataset, fmt::format("has \"{}\" at {}", rims[i].hole, i), "holes of hole/id, in its order");
  };
  check_order("pressure/hole", std::span(a.contact));
  const std::size_t n_loaded = a.contact.size();
  if (a.waves.size() < n_loaded ||
      !std::ranges::equal(a.contact, std::span(a.waves).first(n_loaded), {}, &ContactRim::hole, &WaveRim::hole))
    fail(file, "wave/hole", "does not begin with the holes of pressure/hole", "those, then others");
  check_order("wave/hole", std::span(a.waves).subspan(n_loaded));
  for (int hole = 0; hole < count_of(a.hole_id); ++hole) {
    const bool in_contact = index_of(a.contact, a.hole_id[hole], &ContactRim::hole) < count_of(a.contact);
    if (in_contact && directions[hole].empty())
      fail(file, "pressure/hole", fmt::format("names \"{}\", which has no disc", a.hole_id[hole]), "holes with discs");
    if (in_contact) continue;
    for (const auto& name : rim::friction_cases(directions[hole])) expected.push_back(a.hole_id[hole] + ":" + name);
  }
  for (int i = 0; i < count_of(a.friction_hole); ++i) cases.push_back(a.friction_hole[i] + ":" + a.friction_bearing[i]);
  const auto [found, wanted] = std::ranges::mismatch(cases, expected);
  if (found != cases.end() || wanted != expected.end())
    fail(file, "friction/hole",
         fmt::format("case {} of {} is {}", found - cases.begin(), cases.size(),
                     found == cases.end() ? "missing" : "\"" + *found + "\""),
         wanted == expected.end() ? fmt::format("{} cases", expected.size()) : "\"" + *wanted + "\"");
}

}  // namespace

void check_consistent(const std::string& file, const PlateSolution& plate) {
  const pfem::Edges edges = pfem::find_edges(plate.mesh);
  check_mesh(file, plate.mesh, edges);
  check_rims(file, plate, edges);
  check_unknowns(file, plate);
  check_cases(file, plate, check_discs(file, plate));
}

}  // namespace fastjoint::formats
