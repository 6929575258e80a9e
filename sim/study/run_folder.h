#pragma once

#include <string>
#include <vector>

#include "sim/base/error.h"
#include "sim/scene/image_io.h"

namespace dendro::study {

/// A run directory that appears whole or not at all: files go to a working folder beside it until commit().
class RunFolder {
 public:
  /// Makes the working folder. Throws UserError when nothing can be written there.
  explicit RunFolder(const std::string& path);
  /// Without a commit removes what was made, folders above included.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Where files are to be written now.
  const std::string& work() const { return work_; }
  /// Where they will be.
  const std::string& path() const { return path_; }

  void write(const std::string& name, const std::string& text);
  /// Does what writes into work(); its complaints name the place where the files were to be.
  template <class Action>
  auto writing(const Action& action) const {
    try {
      return action();
    } catch (const UserError& error) {
      rename(error);
    }
  }
  /// Moves everything into place; files of the same names are replaced, others in the directory stay.
  void commit();

 private:
  [[noreturn]] void rename(const UserError& error) const;

  std::string path_, work_;
  std::vector<std::string> made_;  // folders above, outermost first
  bool committed_ = false;
};

/// A picture as PNG that appears whole or not at all. Throws UserError.
void write_picture(const std::string& path, const scene::RgbImage& image);

/// A single output file that appears whole or not at all; a device or pipe is written to directly. "-" is
/// standard output.
class OutputFile {
 public:
  /// Throws UserError when it cannot be written, also for a disk that is full already; an empty path means no file.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where somebody else is to write the file before commit(); the path itself for a device, empty for none.
  const std::string& work() const { return work_.empty() ? path_ : work_; }

  /// Writes the text; a regular file takes its place at commit() only, standard output gets it then.
  void write(const std::string& text);
  void commit();
  void commit(const std::string& text) {
    write(text);
    commit();
  }

 private:
  std::string path_, work_, standard_output_;
};

}  // namespace dendro::study
