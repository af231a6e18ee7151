// The subcommands of motes: each adds itself to the program and runs when it is named.
#pragma once

namespace CLI {
class App;
}

namespace motes {

void add_bench_command(CLI::App& program);
void add_info_command(CLI::App& program);
void add_probe_command(CLI::App& program);
void add_render_command(CLI::App& program);
void add_resample_command(CLI::App& program);
void add_view_command(CLI::App& program);

}  // namespace motes
