// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files of films, which other runs go on with, add to each other and develop.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "film/film.h"
#include "scene/film.h"

namespace caplet {

/// FilmOrigin tells which picture the samples of a film are of.
struct FilmOrigin {
  FilmLayout layout;
  // Hashes (lower/fingerprint.h); empty where unknown.
  std::string scene, view;
};

/// Returns the names by which options ask for layers, without those that every picture has.
std::vector<std::string> options_of(Layers layers);

/// Returns why the samples of the two are not of one picture: a text such as "its size is 20 x 10,
/// not 30 x 10"; empty when they are.
std::string difference(const FilmOrigin& film, const FilmOrigin& other);

/// SavedFilm is a film with all that is needed to add to it and to make its picture, without its
/// scene.
struct SavedFilm {
  Film film;
  std::string scene, view;           // as of FilmOrigin
  std::uint32_t samples_wanted = 0;  // of each pixel of the whole picture; 0: unknown
  // These develop its picture: exposure, white balance, colour space, denoising and
  // backdrop. The rest is not saved.
  FilmSettings settings;
  std::map<std::string, std::string> notes;  // attributes of its pictures (docs/output.md)

  FilmOrigin origin() const { return {film.layout(), scene, view}; }
};

/// Writes an EXR of the sums (docs/output.md), as write_exr does. `seconds`: how long the film
/// took, by which its compression is chosen (compression_for). Throws RunError.
void save_film(const std::filesystem::path& path, const SavedFilm& saved, double seconds = 0);

/// Reads such a file. A backdrop's image is read from the file that it was read from. Throws
/// InputError when a file is missing, broken or no film.
SavedFilm load_film(const std::filesystem::path& path);

/// Returns devices, drivers and program that made a picture, of its notes. Films of which these are
/// the same add to the bits of one render.
std::string made_on(const std::map<std::string, std::string>& notes);

/// Adds the samples of another film, and what its notes tell of devices and times. Throws
/// InputError, and changes nothing, when they are not of one picture or have samples in common.
void add(SavedFilm& to, const SavedFilm& other);

/// Returns the notes of a film that runs with `before` and `now` have made together: `now`, with
/// all devices and the sum of the times.
std::map<std::string, std::string> notes_together(const std::map<std::string, std::string>& before,
                                                  std::map<std::string, std::string> now);

/// Samples [begin, end) of every pixel.
struct SampleSpan {
  std::uint32_t begin = 0, end = 0;
  bool operator==(const SampleSpan&) const = default;
};

/// Returns the samples that all pixels of the film have, in order, without those of smaller
/// windows.
std::vector<SampleSpan> samples_of(const Film& film);
/// Returns them as a text such as "0:16, 32:48".
std::string text_of(const std::vector<SampleSpan>& samples);
/// Returns those below `wanted`, and between `samples`, that are not among them, in order.
std::vector<SampleSpan> missing(const std::vector<SampleSpan>& samples, std::uint32_t wanted);

}  // namespace caplet
