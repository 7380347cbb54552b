// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace fastjoint::input {

/// A JSON text, parsed. Duplicate keys are refused; // and /* */ comments are allowed.
struct Document {
  std::string file;  ///< name for messages
  std::string text;  ///< as read
  std::shared_ptr<const nlohmann::json> root;
};

/// Contents of a regular file. Throws FileError with the path and the reason.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Throws InputError naming the file, line and column of the first mistake.
[[nodiscard]] Document parse(const std::string& file, const std::string& text);

}  // namespace fastjoint::input
