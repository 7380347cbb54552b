// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/pipeline/programs.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace fastjoint::test {
namespace {

Run in_folder(const TemporaryFolder& folder, const char* name, const std::string& words) {
  return run(folder, fmt::format("cd '{}' && '{}' {}", folder.path(""), program(name), words));
}

}  // namespace

Run stage1(const TemporaryFolder& folder, const std::string& words) { return in_folder(folder, "stage1_plate", words); }
Run stage2(const TemporaryFolder& folder, const std::string& words) {
  return in_folder(folder, "stage2_extract", words);
}
Run stage3(const TemporaryFolder& folder, const std::string& words) {
  return in_folder(folder, "stage3_nonlinear", words);
}

std::string example(const std::string& name) {
  const std::string text = read_file(std::string(FASTJOINT_SOURCE) + "/examples/three_fasteners/" + name);
  if (text.empty()) throw std::runtime_error("no example " + name);
  return text;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("the text has no " + what);
  return text.replace(at, what.size(), by);
}

void make_matrices(const TemporaryFolder& folder) {
  for (const std::string name : {"center", "doubler"}) {
    folder.write(name + ".json", example(name + ".json"));
    const Run one = stage1(folder, fmt::format("{0}.json -o {0}.h5", name));
    const Run two = stage2(folder, fmt::format("{0}.h5 -o {0}.m.h5", name));
    if (one.status != 0 || two.status != 0) throw std::runtime_error(one.err + two.err);
  }
}

std::string three_fastener_joint(double k, double load, const std::string& first, const std::string& all) {
  std::string fasteners;
  for (const char* id : {"1", "2", "3"})
    fasteners += fmt::format(R"({}{{"id": "{}", "between": ["center:{}", "doubler:{}"], "law": "bolt"{}{}}})",
                             fasteners.empty() ? "" : ", ", id, id, id, fasteners.empty() ? first : "", all);
  return fmt::format(R"({{"format": "joint", "version": 1,
    "plates": {{"center": "center.m.h5", "doubler": "doubler.m.h5"}},
    "laws": {{"bolt": {{"type": "linear", "k": {}}}}}, "fasteners": [{}],
    "loads": [{{"external": "center:P", "force": {}}}], "increments": 1}})",
                     k, fasteners, load);
}

}  // namespace fastjoint::test
