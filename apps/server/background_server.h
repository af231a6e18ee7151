// A server in the same program as its clients: for tests and benchmarks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>

#include "server/files.h"
#include "server/options.h"
#include "server/server.h"
#include "server/studio.h"

namespace motes::server {

/// A studio, its server and the thread that serves, as long as this lives.
class BackgroundServer {
 public:
  /// Shows `first`. Throws Error as Files and Server do.
  BackgroundServer(const ServerOptions& options, const std::filesystem::path& folder, Opening first)
      : files_(folder, options.max_kept_bytes),
        server_(options, studio_, files_),
        thread_([this] { server_.run(); }) {
    studio_.open(std::move(first));
  }
  ~BackgroundServer() {
    server_.stop();
    thread_.join();
  }
  BackgroundServer(const BackgroundServer&) = delete;
  BackgroundServer& operator=(const BackgroundServer&) = delete;

  std::uint16_t port() const { return server_.port(); }
  const std::string& token() const { return server_.token(); }

 private:
  Files files_;
  Studio studio_;
  Server server_;
  std::thread thread_;
};

}  // namespace motes::server
