#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/parts/service_block/service_block.h"
#include "sim/base/scratch_file.h"

namespace dendro::study {

/// The calls of a program with Linux o32 numbers; what files are is left to who derives from it.
class CallServices : public service_block::Services {
 public:
  struct Fault {
    std::uint32_t cause = 0, epc = 0, address = 0, fpu = 0;
  };

  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>& arguments,
                                 base::ZeroedBytes& memory) final;

  std::optional<int> exit_code;
  std::optional<Fault> fault;  ///< the monitor gave the program up

 protected:
  /// Each returns a value of 0 or more, or an error's number below 0. `flags` are Linux's for MIPS.
  virtual long open_file(const std::string& path, std::uint32_t flags, std::uint32_t mode) = 0;
  virtual long close_file(std::uint32_t file) = 0;
  virtual long read_file(std::uint32_t file, std::uint8_t* to, std::uint32_t bytes) = 0;
  virtual long write_file(std::uint32_t file, const std::uint8_t* from, std::uint32_t bytes) = 0;
  virtual long seek_file(std::uint32_t file, std::int32_t offset, std::uint32_t from) = 0;
  /// A mark: its call's number, 0x7000 up, and its label.
  virtual void mark(std::uint32_t, std::uint32_t) {}
};

/// Carried out by this process: its own standard input and output, files by their host paths.
class HostServices : public CallServices {
 public:
  /// `shows_output`: what the program writes to standard output appears.
  explicit HostServices(bool shows_output = true) : shows_output_(shows_output) {}
  ~HostServices() override;
  HostServices(const HostServices&) = delete;
  HostServices& operator=(const HostServices&) = delete;

 private:
  long open_file(const std::string& path, std::uint32_t flags, std::uint32_t mode) override;
  long close_file(std::uint32_t file) override;
  long read_file(std::uint32_t file, std::uint8_t* to, std::uint32_t bytes) override;
  long write_file(std::uint32_t file, const std::uint8_t* from, std::uint32_t bytes) override;
  long seek_file(std::uint32_t file, std::int32_t offset, std::uint32_t from) override;
  int host_file(std::uint32_t file) const;

  std::map<std::uint32_t, int> files_;  ///< the program's numbers from 3 on
  const bool shows_output_;
};

/// Files in memory, or for large ones on disk, by name. Standard input is empty; what goes to standard output and error is kept as text.
class MemoryServices : public CallServices {
 public:
  using Files = std::map<std::string, std::vector<std::uint8_t>>;
  struct Mark {
    std::uint32_t number = 0, label = 0;
  };

  using LargeFiles = std::map<std::string, base::ScratchFile>;

  /// A file that is named in `large` stays there, all others come to be in `files`.
  explicit MemoryServices(Files& files, LargeFiles* large = nullptr) : files_(files), large_(large) {}

  std::string output, errors;
  std::vector<Mark> marks;

 private:
  struct Open {
    std::vector<std::uint8_t>* bytes = nullptr;
    base::ScratchFile* large = nullptr;  ///< instead of `bytes`
    std::size_t at = 0;

    std::size_t size() const { return large != nullptr ? large->size() : bytes->size(); }
    std::size_t read(std::uint8_t* to, std::size_t count) const;
    void write(const std::uint8_t* from, std::size_t count);
    void clear();
  };

  long open_file(const std::string& path, std::uint32_t flags, std::uint32_t mode) override;
  long close_file(std::uint32_t file) override;
  long read_file(std::uint32_t file, std::uint8_t* to, std::uint32_t bytes) override;
  long write_file(std::uint32_t file, const std::uint8_t* from, std::uint32_t bytes) override;
  long seek_file(std::uint32_t file, std::int32_t offset, std::uint32_t from) override;
  void mark(std::uint32_t number, std::uint32_t label) override { marks.push_back({number, label}); }

  /// The file without its place; neither `bytes` nor `large` if there is none.
  Open find(const std::string& path);

  Files& files_;
  LargeFiles* const large_;
  std::map<std::uint32_t, Open> open_;  ///< the program's numbers from 3 on
};

}  // namespace dendro::study
