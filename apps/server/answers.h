// What the server says to pages (docs/viewer.md, "Protocol"): JSON texts.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/report.h"
#include "document/document.h"
#include "document/histogram.h"
#include "document/pick.h"
#include "scene/camera.h"
#include "server/folder.h"
#include "server/messages.h"

namespace motes::server {

using Sequence = std::optional<std::uint32_t>;

std::string hello_text(ClientId client);
/// What is open.
struct SceneAnswer {
  std::string name;                    ///< of the file
  std::optional<std::size_t> frames;   ///< nullopt: not counted yet
  std::optional<ClientId> client;      ///< whose message is answered, and which
  Sequence sequence;
  bool new_data = false;
};
std::string scene_text(const Document& document, const SceneAnswer& answer);
std::string progress_text(std::string_view activity, double fraction);
std::string ready_text();
std::string error_text(Sequence sequence, std::string_view message);
std::string warnings_text(const Warnings& warnings);
std::string picked_text(std::uint32_t sequence, const Document& document,
                        const std::optional<Pick>& pick);
std::string camera_text(ClientId client, const Camera& camera);
std::string clients_text(const std::map<ClientId, std::optional<ClientId>>& following);
std::string histogram_text(const Document& document, const std::vector<Histogram>& histograms);
std::string statistics_text(const Document& document, const RenderStatistics& frame,
                            double encode_ms, std::size_t clients);
std::string listing_text(std::string_view path, const std::vector<FolderEntry>& entries);

}  // namespace motes::server
