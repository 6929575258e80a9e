#pragma once

#include <functional>
#include <optional>

#include "sim/study/gdb_server.h"

namespace dendro::study {

/// Waits on 127.0.0.1 for one GDB and serves it.
class GdbSocket : public Debugger {
 public:
  /// Port 0: any free one. Throws UserError for one that cannot be had. `look` is called now and then; what it throws
  /// ends the waiting or the program.
  GdbSocket(int port, std::function<std::optional<int>()> exit_code, std::function<void()> look = {});
  ~GdbSocket() override;
  GdbSocket(const GdbSocket&) = delete;
  GdbSocket& operator=(const GdbSocket&) = delete;

  int port() const { return port_; }
  bool killed() const { return killed_; }

  /// A connection that is lost lets go of the program, as a detach does.
  bool debug(Debuggee& program) override;

 private:
  void wait_for(int socket) const;
  bool read_more();
  bool send_all(const std::string& bytes);
  bool interrupted();

  std::function<std::optional<int>()> exit_code_;
  std::function<void()> look_;
  int listener_ = -1, connection_ = -1, port_ = 0;
  std::string received_;
  bool lost_ = false, killed_ = false;
};

}  // namespace dendro::study
