// motes view: a server that shows the scene in browsers.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "document/input.h"
#include "motes/commands.h"
#include "motes/count_option.h"
#include "motes/interrupt.h"
#include "motes/scene_options.h"
#include "motes/thread_limit.h"
#include "render/render_tile.h"
#include "server/access.h"
#include "server/files.h"
#include "server/server.h"
#include "server/studio.h"

namespace motes {
namespace {

constexpr const char* footer =
    R"(Open the address that is printed in any browser; it holds the token without which the server
answers nobody. Options change what is shown first, as those of 'motes render' do. Ctrl-C ends.

Examples:
  motes view silica.lammpstrj
  motes view scene.json --port 8080
  motes view run.xyz --folder /data/runs
On a cluster, the line for the tunnel is printed too; see docs/viewer.md.)";

struct Options {
  std::string path, folder;
  int threads = 0;
  server::ServerOptions server;
  SceneChanges changes;
};

/// "/", or "/name/".
std::string normal_base_url(std::string url) {
  if (!url.starts_with('/')) url.insert(0, "/");
  if (!url.ends_with('/')) url += '/';
  return url;
}

void run(Options options) {
  const ThreadLimit limit(options.threads);
  instruction_set();  // a MOTES_TARGET that is not to be had is told at once
  // Not an option, which everybody on the machine could read.
  if (const char* token = std::getenv("MOTES_VIEW_TOKEN"); token != nullptr && *token != 0) {
    server::check_token(token, "MOTES_VIEW_TOKEN");
    options.server.token = token;
  }
  options.server.base_url = normal_base_url(options.server.base_url);
  const std::filesystem::path path = std::filesystem::absolute(options.path);
  if (!std::filesystem::exists(path)) throw Error(path, "there is no such file");
  if (options.folder.empty()) options.folder = path.parent_path().string();

  server::Files files(options.folder, options.server.max_kept_bytes);
  Scene scene = open_scene(path);
  options.changes.apply(scene);
  files.allow(scene);
  server::Studio studio;
  server::Server server(options.server, studio, files);
  studio.open({.name = path.filename().string(),
               .scene = [scene] { return scene; },
               .failed =
                   [](const std::optional<std::string>& error) {
                     if (error) fmt::print(stderr, "motes: error: {}\n", *error);
                   }});
  const char* user = std::getenv("USER");
  fmt::print("{}", server.greeting(user != nullptr ? user : "", server::machine_name()));
  std::fflush(stdout);
  const StopWhenInterrupted stop([&server] { server.stop(); });
  server.run();
}

}  // namespace

void add_view_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("view", "Look at particles in a browser.");
  const auto options = std::make_shared<Options>();
  server::ServerOptions& server = options->server;
  command->add_option("FILE", options->path, "particles, grids, or a scene")
      ->required()
      ->type_name("");
  command->add_option("--port", server.port, "port to listen on (default: one that is free)")
      ->type_name("PORT");
  command
      ->add_option("--address", server.address,
                   "address to listen on (default: 127.0.0.1, this machine alone)")
      ->type_name("ADDRESS");
  command
      ->add_option("--folder", options->folder,
                   "the folder whose files the page may open (default: FILE's)")
      ->type_name("DIR");
  command
      ->add_option("--base-url", server.base_url, "the path under which a proxy shows the server")
      ->type_name("/PATH/");
  command
      ->add_option("--host", server.hosts,
                   "a further name under which the server is reached, such as a proxy's")
      ->type_name("NAME");
  add_count(*command, "--threads", options->threads, 4096, "threads to use (default: all cores)");
  add_picture_options(*command, options->changes);
  add_field_options(*command, options->changes);
  add_data_options(*command, options->changes);
  command->footer(footer);
  command->callback([options] { run(std::move(*options)); });
}

}  // namespace motes
