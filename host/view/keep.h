// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Data that outlive a session: the saved scene and unsaved changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "view/journal.h"

namespace caplet::view {

/// The files of a session of one scene file.
///
/// Changes are lines of a journal, `.NAME.unsaved` beside the scene's file NAME or, where that
/// folder is not writable, in the cache: the messages of the page in order, including undos, so
/// that replaying them on the same content gives the same scene and the same undo history. The
/// first line has a hash of that content and the options it was read with. The journal exists from
/// the first change to the next save. The content before a save is kept beside it,
/// `.STEM.unsaved.pbrt`, during the session: later lines of changes start from it, too.
///
/// If two sessions open one file at the same time, the second keeps nothing.
class Keeper {
 public:
  /// The reading options of a user, by name. Changes made with other options do not fit this scene.
  using ReadAs = std::map<std::string, std::string>;

  /// Looks for files of an earlier session. `scene` must exist.
  explicit Keeper(const std::filesystem::path& scene, const ReadAs& read_as = {});
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// Returns the file to import: the scene's file, or its former content.
  const std::filesystem::path& base() const { return base_is_copy_ ? copy_ : scene_; }
  /// Tells which other files base() was read from. It must be called once, after reading.
  void has_read(const std::vector<std::string>& files);
  /// Starts hashing the files on another thread; to be called when the processor is idle. The first
  /// change also starts it, and waits for it.
  void look_at_contents();

  /// Returns the lines that an earlier session left for base(), oldest first. They must be replayed
  /// before other changes.
  const std::vector<std::string>& lines() const { return lines_; }
  /// Reports that the first `count` lines could be replayed; the others are put aside.
  void has_made(std::size_t count);
  /// Lines that an earlier session left for other content, newest first; null where there are none.
  struct Old {
    std::filesystem::path file;
    std::vector<std::string> lines;  // since the last save
  };
  const Old* old() const { return old_.empty() ? nullptr : &old_.back(); }
  void forget_old();

  /// Records a change as a line.
  void keep(const std::string& line);
  /// Returns why changes cannot be kept; empty if they can.
  const std::string& failure() const { return failure_; }
  /// Returns the journal's path.
  const std::filesystem::path& journal() const { return journal_; }

  /// Returns the file of a name, beside the scene's; without a name the last one, or the scene's
  /// own name as .pbrt. Throws InputError for an invalid name, or one that leads to another folder.
  std::filesystem::path target(const std::optional<std::string>& name) const;
  std::string default_name() const { return default_name_; }
  /// Describes what overwriting the file would lose; empty if nothing.
  std::string lost_with(const std::filesystem::path& target) const;
  /// Writes the scene and ends the journal. `mark` is kept with later changes. Throws as
  /// write_scene does, and then leaves everything as before.
  void save(const Scene& scene, const std::filesystem::path& target, const std::string& mark,
            const std::function<bool()>& cancelled = {});

  /// Removes the journal until the next change, because all changes are saved or undone.
  void rest();
  /// Ends the session. The journal stays if there are unsaved changes.
  void end(bool has_unsaved);

 private:
  using Others = std::vector<std::pair<std::string, std::string>>;  // files and hashes

  std::string head() const;
  void find_left(const std::filesystem::path& journal);
  void put_aside(const std::filesystem::path& journal);
  void write_journal();
  void fail(const std::string& why);

  ReadAs read_as_;
  std::filesystem::path scene_, copy_, journal_,
      elsewhere_;  // elsewhere: the journal's alternative path
  std::filesystem::path lock_file_;
  int lock_ = -1;
  bool base_is_copy_ = false, is_second_ = false;
  std::string failure_, default_name_;
  std::vector<std::string> lines_;
  std::vector<Old> old_;
  Journal file_;
  struct Content {
    std::string path;
    std::int64_t bytes = -1,
                 written =
                     0;  // at the time of reading; if they differ later, the content is unknown
  };
  static Content content_of(const std::filesystem::path& file);
  static std::string hash_of(const Content& content);

  std::shared_future<std::string> scene_hash_;  // at the time of reading or of the last save
  std::shared_future<std::string> base_hash_;
  std::shared_future<Others> others_;
  std::future<void> looking_;
  std::map<std::filesystem::path, std::string> written_;  // hashes of files that this session wrote
};

/// Returns the token stored for this address and scene, or a new one that is stored: an open page
/// then continues with the next session. It is in the cache, in a file that only this user can
/// read.
std::string kept_token(const std::string& host, std::uint16_t port,
                       const std::filesystem::path& scene);

}  // namespace caplet::view
