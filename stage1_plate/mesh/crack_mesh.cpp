// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/count.hpp"
#include "common/pfem/material.hpp"

namespace fastjoint::stage1 {
namespace {

/// A path in order, from one end to the other.
struct CrackLine {
  std::vector<int> nodes;
  bool starts_inside, ends_inside;  ///< true for a tip
};

/// The edges of a path in a row. Throws InputError if they are no such row.
std::vector<int> in_order(const PlateScene& scene, const CrackPath& path) {
  std::map<int, std::vector<int>> next;
  for (const auto& [a, b] : path.edges) next[a].push_back(b), next[b].push_back(a);
  std::vector<int> ends;
  for (const auto& [node, others] : next) {
    if (others.size() > 2)
      reject(scene, path.pointer, fmt::format("{} edges of the crack meet at node {}", others.size(), node),
             "one line without branches");
    if (others.size() == 1) ends.push_back(node);
  }
  if (ends.size() != 2)
    reject(scene, path.pointer, fmt::format("edges of the crack that have {} ends", ends.size()),
           "one line with two ends");
  std::vector<int> nodes{ends[0]};
  for (int last = -1; nodes.back() != ends[1];) {
    const auto& others = next[nodes.back()];
    const int to = others.size() == 2 && others[0] == last ? others[1] : others[0];
    last = nodes.back();
    nodes.push_back(to);
  }
  if (nodes.size() != path.edges.size() + 1)
    reject(scene, path.pointer, "edges of the crack that are not connected", "one line with two ends");
  return nodes;
}

CrackLine line_of(const PlateScene& scene, const PlateMesh& plate, const CrackPath& path) {
  CrackLine line{in_order(scene, path), true, true};
  std::set<int> on_border;
  for (int edge = 0; edge < plate.edges.size(); ++edge)
    if (plate.edges.is_border(edge)) on_border.insert({plate.edges.nodes(0, edge), plate.edges.nodes(1, edge)});
  for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
    const int a = line.nodes[i], b = line.nodes[i + 1];
    if (plate.edges.is_border(edge_between(scene, plate.edges, path.pointer, a, b)))
      reject(scene, path.pointer, fmt::format("the edge between nodes {} and {} is on the border already", a, b),
             "edges inside the sheet");
    if (i > 0 && on_border.contains(a))
      reject(scene, path.pointer, fmt::format("the crack touches the border at node {} on its way", a),
             "a crack that meets the border at its ends only");
  }
  line.starts_inside = !on_border.contains(line.nodes.front());
  line.ends_inside = !on_border.contains(line.nodes.back());
  return line;
}

/// Elements at each node, with the local vertex.
std::multimap<int, pfem::Side> elements_at_nodes(const pfem::Mesh& mesh) {
  std::multimap<int, pfem::Side> at;
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int vertex = 0; vertex < 4; ++vertex) at.insert({mesh.quads(vertex, element), {element, vertex}});
  return at;
}

/// Elements at a node that are to the left of a line through it: those that are reached from the left side of its edges
/// at the node without crossing one of them.
std::vector<pfem::Side> left_of(const pfem::Mesh& mesh, const std::multimap<int, pfem::Side>& elements,
                                const std::vector<int>& line, std::size_t i) {
  const int node = line[i];
  std::vector<pfem::Side> around;
  for (auto [at, last] = elements.equal_range(node); at != last; ++at) around.push_back(at->second);
  const auto vertex = [&](const pfem::Side& of, int steps) {
    return mesh.quads((of.local_edge + steps) % 4, of.element);
  };
  const auto on_line = [&](int other) {
    return (i > 0 && line[i - 1] == other) || (i + 1 < line.size() && line[i + 1] == other);
  };
  // Counter-clockwise from the edge to the next node of the line, or up to that from the one before.
  std::vector<pfem::Side> left;
  const bool has_next = i + 1 < line.size();
  int border = has_next ? line[i + 1] : line[i - 1];
  for (bool more = true; more;) {
    more = false;
    for (const auto& each : around)
      if (vertex(each, has_next ? 1 : 3) == border) {
        left.push_back(each);
        border = vertex(each, has_next ? 3 : 1);
        more = !on_line(border);
        break;
      }
  }
  return left;
}

/// Doubles the nodes of a line but its tips, in the elements to its left, and gives arcs their new ends.
void double_nodes(const CrackLine& line, pfem::Mesh& mesh) {
  const auto elements = elements_at_nodes(mesh);
  std::map<int, int> twin;
  std::vector<Eigen::Vector2d> added;
  std::vector<std::pair<pfem::Side, int>> changes;
  for (std::size_t i = 0; i < line.nodes.size(); ++i) {
    const bool is_tip = (i == 0 && line.starts_inside) || (i + 1 == line.nodes.size() && line.ends_inside);
    if (is_tip) continue;
    const int node = line.nodes[i], copy = mesh.n_nodes() + count_of(added);
    added.emplace_back(mesh.nodes.col(node));
    twin[node] = copy;
    for (const auto& at : left_of(mesh, elements, line.nodes, i)) changes.emplace_back(at, copy);
  }
  for (const auto& [at, copy] : changes) mesh.quads(at.local_edge, at.element) = copy;
  const Eigen::Index n = mesh.nodes.cols();
  mesh.nodes.conservativeResize(2, n + std::ssize(added));
  for (Eigen::Index k = 0; k < std::ssize(added); ++k) mesh.nodes.col(n + k) = added[k];
  const pfem::Edges edges = pfem::find_edges(mesh);
  const auto both = [&](int node) {
    const auto found = twin.find(node);
    return found == twin.end() ? std::vector{node} : std::vector{node, found->second};
  };
  std::vector<pfem::Arc> arcs;
  for (const auto& arc : mesh.arcs)
    for (const int a : both(arc.a))
      for (const int b : both(arc.b))
        if (edges.between(a, b) >= 0) arcs.push_back({a, b, arc.center});
  mesh.arcs = std::move(arcs);
}

/// A tip before its elements are cut.
struct OpenTip {
  pfem::CrackTip tip;
  int node;
  std::string pointer;
};

/// Cuts the elements around tips into layers.
class Grader {
 public:
  Grader(PlateMesh& plate, int n_layers) : plate_(plate), n_layers_(n_layers) {
    const auto& mesh = plate.mesh;
    for (int k = 0; k < mesh.n_elements(); ++k) {
      quads_.emplace_back(mesh.quads.col(k));
      thickness_.push_back(mesh.thickness[k]);
      material_.push_back(mesh.material[k]);
    }
    for (int k = 0; k < mesh.n_nodes(); ++k) nodes_.emplace_back(mesh.nodes.col(k));
  }

  void cut(OpenTip& open) {
    scaled_.clear();
    tips_.insert(open.node);
    open.tip.layers.assign(n_layers_, {});
    const int n = count_of(quads_);
    for (int element = 0; element < n; ++element)
      for (int vertex = 0; vertex < 4; ++vertex)
        if (quads_[element][vertex] == open.node) cut(element, vertex, open);
  }

  /// Gives the plate its new mesh, and sets and sections the sides that their elements have now.
  void finish() {
    pfem::Mesh& mesh = plate_.mesh;
    using Eigen::Map;
    mesh.nodes = Map<const Eigen::Matrix2Xd>(nodes_.data()->data(), 2, std::ssize(nodes_));
    mesh.quads = Map<const Eigen::Matrix4Xi>(quads_.data()->data(), 4, std::ssize(quads_));
    mesh.thickness = Map<const Eigen::VectorXd>(thickness_.data(), std::ssize(thickness_));
    mesh.material = Map<const Eigen::VectorXi>(material_.data(), std::ssize(material_));
    // Lines from a tip are straight now.
    std::erase_if(mesh.arcs, [&](const pfem::Arc& arc) { return tips_.contains(arc.a) || tips_.contains(arc.b); });
    const auto follow = [&](std::vector<pfem::Side>& sides) {
      std::vector<pfem::Side> now;
      for (const auto& side : sides)
        if (const auto found = moved_.find(side); found != moved_.end())
          now.insert(now.end(), found->second.begin(), found->second.end());
        else
          now.push_back(side);
      sides = std::move(now);
    };
    for (auto& [name, sides] : plate_.sets) follow(sides);
    for (auto& section : plate_.sections) follow(section.sides);
  }

 private:
  /// An element with its vertex at the tip becomes two elements in each layer and a smaller copy of itself at the tip.
  void cut(int element, int vertex, OpenTip& open) {
    const Eigen::Vector4i old = quads_[element];
    std::array<int, 3> outer{};  // counter-clockwise without the tip
    for (int k = 0; k < 3; ++k) outer[k] = old[(vertex + 1 + k) % 4];
    for (int layer = 0; layer < n_layers_; ++layer) {
      std::array<int, 3> inner{};
      for (int k = 0; k < 3; ++k) inner[k] = scaled(old[(vertex + 1 + k) % 4], layer + 1, open.node);
      for (int k = 0; k < 2; ++k) {
        const Eigen::Vector4i quad(inner[k], outer[k], outer[k + 1], inner[k + 1]);
        const bool is_first = layer == 0 && k == 0;
        const int at = is_first ? element : count_of(quads_);
        if (is_first)
          quads_[element] = quad;
        else
          add(quad, element);
        if (layer == 0) moved_[{element, (vertex + 1 + k) % 4}] = {{at, 1}};
        moved_[{element, (vertex + 3 * k) % 4}].push_back({at, 2 * k});  // a piece of the side that ends at the tip
        open.tip.layers[layer].push_back(at);
      }
      outer = inner;
    }
    for (const int k : {0, 1}) moved_[{element, (vertex + 3 * k) % 4}].push_back({count_of(quads_), 3 * k});
    add(Eigen::Vector4i(open.node, outer[0], outer[1], outer[2]), element);
  }

  void add(const Eigen::Vector4i& quad, int like) {
    quads_.push_back(quad);
    thickness_.push_back(thickness_[like]);
    material_.push_back(material_[like]);
  }

  /// The node on the line from a tip to a node, nearer to the tip by a power of the grading factor.
  int scaled(int node, int power, int tip) {
    constexpr double grading = 0.2;
    const auto [found, is_new] = scaled_.try_emplace({node, power}, count_of(nodes_));
    if (is_new) {
      const Eigen::Vector2d at = nodes_[tip] + std::pow(grading, power) * (nodes_[node] - nodes_[tip]);
      nodes_.push_back(at);
    }
    return found->second;
  }

  PlateMesh& plate_;
  int n_layers_;
  std::vector<Eigen::Vector2d> nodes_;
  std::vector<Eigen::Vector4i> quads_;
  std::vector<double> thickness_;
  std::vector<int> material_;
  std::map<std::pair<int, int>, int> scaled_;
  std::set<int> tips_;
  std::map<pfem::Side, std::vector<pfem::Side>> moved_;  ///< keys: where they were
};

/// Checks the sheet around a tip, where the dual fields hold for one isotropic material.
void check_around(const PlateScene& scene, const pfem::Mesh& mesh, const OpenTip& open) {
  std::optional<int> first;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    if ((mesh.quads.col(element).array() != open.node).all()) continue;
    if (!first) first = element;
    const std::string place = fmt::format("the tip at ({:g}, {:g})", open.tip.at.x(), open.tip.at.y());
    if (!pfem::is_isotropic(scene.elasticity[mesh.material[element]]))
      reject(scene, open.pointer, fmt::format("{} is in an anisotropic material", place),
             "tips in isotropic sheets: stress intensity factors of anisotropic ones are not computed");
    if (mesh.thickness[element] != mesh.thickness[*first] || mesh.material[element] != mesh.material[*first])
      reject(scene, open.pointer, fmt::format("{} touches several thicknesses or materials", place),
             "tips away from steps of the sheet");
  }
}

/// Throws InputError if an element has two tips, since it can be graded towards one only.
void check_apart(const PlateScene& scene, const pfem::Mesh& mesh, const std::vector<OpenTip>& tips) {
  std::map<int, const OpenTip*> tip_of;
  for (const auto& tip : tips) tip_of[tip.node] = &tip;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const OpenTip* first = nullptr;
    for (const int node : mesh.quads.col(element)) {
      const auto found = tip_of.find(node);
      if (found == tip_of.end()) continue;
      if (first)
        reject(
            scene, found->second->pointer,
            fmt::format("the tips of cracks \"{}\" and \"{}\" share an element", first->tip.id, found->second->tip.id),
            "an element between tips: draw a cell line there, or cut the mesh finer");
      first = found->second;
    }
  }
}

/// The tips of a line.
std::vector<OpenTip> tips_of(const PlateScene& scene, const pfem::Mesh& mesh, const CrackPath& path,
                             const CrackLine& line) {
  const Crack& crack = scene.cracks[path.crack];
  const auto at = [&](std::size_t i) -> Eigen::Vector2d { return mesh.nodes.col(line.nodes[i]); };
  const std::size_t last = line.nodes.size() - 1;
  double length = 0;
  for (std::size_t i = 0; i < last; ++i) length += (at(i + 1) - at(i)).norm();
  const bool two = line.starts_inside && line.ends_inside;
  std::vector<OpenTip> tips;
  const auto add = [&](std::size_t tip, std::size_t before, const char* suffix) {
    const Eigen::Vector2d ahead = at(tip) - at(before);
    tips.push_back(
        {{crack.id + (two ? suffix : ""), at(tip), std::atan2(ahead.y(), ahead.x()), two ? length / 2 : length},
         line.nodes[tip],
         path.pointer});
  };
  if (line.starts_inside) add(0, 1, " start");
  if (line.ends_inside) add(last, last - 1, " end");
  return tips;
}

/// Number of layers around a tip: enough that the innermost one adds no more to a stress intensity factor than the
/// elements of degree p leave (docs/theory.md, section 11.7).
int layers_for(int p) { return std::max(2, p - 1); }

}  // namespace

void open_cracks(const PlateScene& scene, const std::vector<CrackPath>& paths, PlateMesh& plate) {
  if (paths.empty()) return;
  std::vector<OpenTip> tips;
  for (const auto& path : paths) {
    const CrackLine line = line_of(scene, plate, path);
    for (auto& tip : tips_of(scene, plate.mesh, path, line)) tips.push_back(std::move(tip));
    double_nodes(line, plate.mesh);
    plate.edges = pfem::find_edges(plate.mesh);
  }
  for (const auto& tip : tips) check_around(scene, plate.mesh, tip);
  check_apart(scene, plate.mesh, tips);
  Grader grader(plate, layers_for(scene.p_high));
  for (auto& tip : tips) grader.cut(tip);
  grader.finish();
  plate.edges = pfem::find_edges(plate.mesh);
  for (auto& each : tips) plate.tips.push_back(std::move(each.tip));
}

}  // namespace fastjoint::stage1
