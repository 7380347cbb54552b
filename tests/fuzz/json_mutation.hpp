// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

// libFuzzer's own mutation of bytes.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace fastjoint::fuzz {

/// Changes of a JSON text that leave it JSON, which those of bytes seldom do: a value at any place is lost, stands
/// twice, becomes another one of the same text or one of another type, or a number of another size.
class JsonMutation {
 public:
  JsonMutation(const std::string& text, unsigned seed)
      : random_(seed), root_(Json::parse(text, nullptr, false, true)) {}

  /// The changed text; empty if the text is no JSON.
  std::string text() {
    if (root_.is_discarded()) return {};
    const int n_changes = 1 + int(below(3));
    for (int i = 0; i < n_changes; ++i) change();
    return root_.dump(-1, ' ', false, Json::error_handler_t::replace);
  }

 private:
  using Json = nlohmann::ordered_json;

  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void collect(Json& value) {
    places_.push_back(&value);
    if (value.is_structured())
      for (auto& each : value) collect(each);
  }

  void change() {
    places_.clear();
    collect(root_);
    Json& place = *places_[below(places_.size())];
    switch (below(6)) {
      case 0:
        if (place.is_structured() && !place.empty())
          place.erase(std::next(place.begin(), std::ptrdiff_t(below(place.size()))));
        break;
      case 1:
        if (place.is_array() && !place.empty()) place.push_back(place[below(place.size())]);
        break;
      case 2:
        place = Json(*places_[below(places_.size())]);
        break;
      case 3:
        place = other_[below(other_.size())];
        break;
      default:
        if (place.is_number()) place = place.get<double>() * factors_[below(factors_.size())];
    }
  }

  std::mt19937 random_;
  Json root_;
  std::vector<Json*> places_;
  const std::vector<Json> other_{nullptr, true, 0,   1,       -1,  2.5, 1e-320,        1e300,         4294967297,
                                 "",      "x",  "y", "/a/b:", ":", "*", Json::array(), Json::object()};
  const std::vector<double> factors_{0, -1, 0.5, 2, 0.999999, 1.000001, 1e-3, 1e3, 1e-30, 1e30};
};

}  // namespace fastjoint::fuzz

/// What libFuzzer calls to change an input; one change of five is of bytes.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  const std::string before(reinterpret_cast<const char*>(data), size);
  const std::string after = seed % 5 == 0 ? "" : fastjoint::fuzz::JsonMutation(before, seed).text();
  if (after.empty() || after.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(after.begin(), after.end(), data);
  return after.size();
}
