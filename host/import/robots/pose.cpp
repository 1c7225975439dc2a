// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/robot.h"
#include "import/detail/text_file.h"

namespace caplet {

Pose::Pose(const ImportOptions& options) {
  const std::string text = options.text("pose").value_or("");
  if (text.empty()) return;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos && begin == 0 && !part.empty())
      keyframe = part;
    else if (equals == std::string::npos || equals == 0)
      throw InputError({"--pose"}, quoted(std::string_view(part)) + " is not JOINT=VALUE");
    else
      joints[part.substr(0, equals)] =
          numbers_of(part.substr(equals + 1), 1, 7, {"--pose"}, part.substr(0, equals));
    begin = end + 1;
  }
}

}  // namespace caplet
