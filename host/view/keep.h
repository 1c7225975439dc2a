// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What outlives a session: the scene as it is saved, and changes that are not.
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

/// Files of a session of one scene file.
///
/// Changes that are made are lines of a journal, `.NAME.unsaved` beside the scene's file NAME or, where that folder cannot be
/// written, in the cache: what the page said, in its order, undos too, so that the same lines made again on the same content give
/// the same scene with the same way back. Its first line names that content by a hash, and how it was read. The journal is there
/// from the first change to the next save. What the file held before it was saved over stays beside it, `.STEM.unsaved.pbrt`,
/// while the session lasts: the lines of changes after that begin there, too.
///
/// If two sessions show one file at a time, the second keeps nothing.
class Keeper {
 public:
  /// What a user asked of the file's reader, by name: another scene, to which changes of this one do not belong.
  using ReadAs = std::map<std::string, std::string>;

  /// Looks for what an earlier session left. `scene` exists.
  explicit Keeper(const std::filesystem::path& scene, const ReadAs& read_as = {});
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// What is to be imported: the file, or what it held before.
  const std::filesystem::path& base() const { return base_is_copy_ ? copy_ : scene_; }
  /// Other files that base() was read from. To be called once, when it has been.
  void has_read(const std::vector<std::string>& files);
  /// To be called when nobody waits for the processor: from now on the files' contents are looked at, elsewhere. The first change
  /// does it too, and waits.
  void look_at_contents();

  /// Lines that an earlier session left of base(), oldest first, to be made again before any other.
  const std::vector<std::string>& lines() const { return lines_; }
  /// The first `count` of them could be made again; others are put aside.
  void has_made(std::size_t count);
  /// What an earlier session left of another content, newest first; null where there is none.
  struct Old {
    std::filesystem::path file;
    std::vector<std::string> lines;  // since the file was saved last
  };
  const Old* old() const { return old_.empty() ? nullptr : &old_.back(); }
  void forget_old();

  /// A change that was made, as a line.
  void keep(const std::string& line);
  /// Why changes are not kept; empty where they are, or would be.
  const std::string& failure() const { return failure_; }
  /// Where they are kept.
  const std::filesystem::path& journal() const { return journal_; }

  /// The file that a name means, beside the scene's; none: the last one, or the scene's own as .pbrt. Throws InputError for a
  /// name that is none, or leads elsewhere.
  std::filesystem::path target(const std::optional<std::string>& name) const;
  std::string default_name() const { return default_name_; }
  /// What would be lost with the file that is there, in words; empty when nothing would be.
  std::string lost_with(const std::filesystem::path& target) const;
  /// Writes the scene, and ends the journal. `mark` is kept with what comes after. Throws as write_scene does, and then all is as
  /// before.
  void save(const Scene& scene, const std::filesystem::path& target, const std::string& mark,
            const std::function<bool()>& cancelled = {});

  /// All that was changed is saved, or taken back: there is no journal until the next change.
  void rest();
  /// Nothing more comes. What is kept stays when it has unsaved changes.
  void end(bool has_unsaved);

 private:
  using Others = std::vector<std::pair<std::string, std::string>>;  // files and hashes

  std::string head() const;
  void find_left(const std::filesystem::path& journal);
  void put_aside(const std::filesystem::path& journal);
  void write_journal();
  void fail(const std::string& why);

  ReadAs read_as_;
  std::filesystem::path scene_, copy_, journal_, elsewhere_;  // elsewhere: the journal's second place
  std::filesystem::path lock_file_;
  int lock_ = -1;
  bool base_is_copy_ = false, is_second_ = false;
  std::string failure_, default_name_;
  std::vector<std::string> lines_;
  std::vector<Old> old_;
  Journal file_;
  struct Content {
    std::string path;
    std::int64_t bytes = -1, written = 0;  // when it was read; another time since: the content is not known
  };
  static Content content_of(const std::filesystem::path& file);
  static std::string hash_of(const Content& content);

  std::shared_future<std::string> scene_hash_;  // as it was read, or saved last
  std::shared_future<std::string> base_hash_;
  std::shared_future<Others> others_;
  std::future<void> looking_;
  std::map<std::filesystem::path, std::string> written_;  // by this session
};

/// The token kept for this address and scene, or a fresh one that is kept from now on: a page that is open goes on with the next
/// session. In the cache, in a file for this user alone.
std::string kept_token(const std::string& host, std::uint16_t port, const std::filesystem::path& scene);

}  // namespace caplet::view
