// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes scenes as files: pbrt-v4 text of the whole model, which importers read back to the same
// picture, bit for bit (docs/formats/pbrt.md, "Written by Caplet").
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "scene/image_writer.h"
#include "scene/scene.h"

namespace caplet {

/// The first line of every scene that is written.
inline constexpr std::string_view written_first_line = "# pbrt-v4 text with Caplet's shapes\n";

/// Replaces `file` (.pbrt, or what is no regular file) as write_atomically does. Images and other
/// files that the scene was read from are named relative to the file's folder where they share a
/// folder with it other than the root, else by their paths. `images` writes those that are in no
/// file beside `file`. `cancelled` is called regularly; when it returns true, RunError is thrown
/// and nothing is written. Throws InputError, at its place, for anything that text cannot express:
/// an image that is in no file where nothing writes it, what validate() refuses, a name with
/// control characters; RunError when writing fails.
void write_scene(const Scene& scene, const std::filesystem::path& file,
                 const std::function<bool()>& cancelled = {}, const ImageWriter* images = nullptr);

/// Passes the text for a file in `folder` on in pieces of bounded size.
void write_pbrt(const Scene& scene, const std::filesystem::path& folder,
                const std::function<void(std::string_view)>& sink,
                const std::function<bool()>& cancelled = {});

}  // namespace caplet
