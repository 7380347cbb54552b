// SPDX-License-Identifier: GPL-3.0-or-later
// STUDY.json of a joint, and the numbers of a sample of it.
#include "stage3_nonlinear/study/study_scene.hpp"
#include "tests/fuzz/json_mutation.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fastjoint;
  static const auto joint = input::parse("joint_laws.json", input::read_text_file("joint_laws.json"));
  return fuzz::read(data, size, [](const std::string& text) {
    input::check_is_text("STUDY.json", text);
    const auto study = stage3::read_study_scene(input::parse("STUDY.json", text), joint);
    (void)stage3::sample_values(study, study.seed.value_or(1), study.n_samples - 1);
    for (const auto& variable : study.variables)
      (void)(stage3::middle_of(variable) + stage3::largest_of(variable) + stage3::spread_of(variable));
  });
}
