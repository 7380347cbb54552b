// SPDX-License-Identifier: GPL-3.0-or-later
// PLATE.json, and the mesh of a scene that is read, which checks what holes, cracks and cells have to do with each
// other.
#include "stage1_plate/mesh/plate_mesh.hpp"
#include "stage1_plate/scene/scene.hpp"
#include "tests/fuzz/json_mutation.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fastjoint;
  return fuzz::read(data, size, [](const std::string& text) {
    input::check_is_text("PLATE.json", text);
    (void)stage1::make_mesh(stage1::read_scene(input::parse("PLATE.json", text)));
  });
}
