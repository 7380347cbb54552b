// SPDX-License-Identifier: GPL-3.0-or-later
// JOINT.json with its laws, each then asked for a force.
#include "stage3_nonlinear/scene/joint_scene.hpp"
#include "tests/fuzz/json_mutation.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fastjoint;
  return fuzz::read(data, size, [](const std::string& text) {
    input::check_is_text("JOINT.json", text);
    for (const auto& [name, law] : stage3::read_joint_scene(input::parse("JOINT.json", text)).laws)
      (void)law.law->at(law.law->coordinate(10, 1e3, 0.01), 1e3, 0.01);
  });
}
