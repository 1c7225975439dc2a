// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The film of a render as a file: shares of samples, checkpoints, and going on.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <string>

#include "film/film_file.h"
#include "render/session.h"

namespace caplet::cli {

/// The exit code of renders that were stopped before their end and keep their film: "temporary
/// failure", EX_TEMPFAIL of sysexits.h. The same command with --resume goes on.
constexpr int exit_stopped = 75;

/// The options of `render` about its film.
struct FilmFlags {
  std::string samples, film;
  std::optional<double> checkpoint;
  bool resume = false;

  /// Returns whether the film is written.
  bool keeps() const { return !film.empty() || checkpoint || resume; }
};

void add_film_flags(CLI::App& command, FilmFlags& flags);

/// Parses "A:B", samples A to B - 1 of every pixel, or "I/N", the share I (from 1) of N equal ones
/// of `wanted` samples. Throws InputError that names --samples.
SampleSpan parse_samples(const std::string& text, std::uint32_t wanted);

/// Keeps the film of one render in a file.
class FilmOutput {
 public:
  /// `like`: what is saved besides film and notes. With `resumes`, a film that is at `path` is
  /// read. Throws InputError when it is broken.
  FilmOutput(std::filesystem::path path, SavedFilm like, bool resumes);
  /// Waits for the checkpoint that is being written.
  ~FilmOutput();
  FilmOutput(const FilmOutput&) = delete;
  FilmOutput& operator=(const FilmOutput&) = delete;

  /// Lets a session that begins with sample `begin` go on after the samples of the film that was
  /// read. Warns when its devices or program (`now`: the notes of this run) are others. Throws
  /// InputError when it is of another picture or begins with another sample.
  void resume(Session& session, std::uint32_t begin, const std::map<std::string, std::string>& now);
  /// Returns the notes of a picture with those of the runs before.
  std::map<std::string, std::string> notes(std::map<std::string, std::string> now) const;

  /// Writes a film on another thread; not at all while the one before is being written. A failure
  /// is a warning, and the file stays as it was.
  void checkpoint(Film film, std::map<std::string, std::string> notes, double seconds);
  /// Writes the film in the end, which is left as it is. Throws RunError.
  void finish(Film& film, std::map<std::string, std::string> notes, double seconds);

 private:
  std::filesystem::path path_;
  SavedFilm like_;
  std::optional<SavedFilm> before_;
  std::map<std::string, std::string> notes_before_;
  std::future<void> writing_;
};

}  // namespace caplet::cli
