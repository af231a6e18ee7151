// What the server says to pages (docs/viewer.md, "Protocol"): JSON texts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/report.h"
#include "document/document.h"
#include "scene/camera.h"
#include "server/folder.h"
#include "server/messages.h"

namespace motes::server {

using Sequence = std::optional<std::uint32_t>;

/// `uploads`: the folder below which the files of clients have temporary names.
std::string hello_text(ClientId client, const std::filesystem::path& uploads);
/// Whose message is answered, and which; and what else there is to say.
struct SceneAnswer {
  std::optional<ClientId> client = {};
  Sequence sequence = {};
  bool new_data = false;  ///< clients take the scene's camera
  bool fitted = false;    ///< that camera was fitted to the data
};
/// `frames`: of the document's file, if they have been counted.
std::string scene_text(const Document& document, std::optional<std::size_t> frames,
                       const SceneAnswer& answer);
std::string progress_text(std::string_view activity, double fraction);
std::string ready_text();
std::string error_text(Sequence sequence, std::string_view message);
std::string warnings_text(const Warnings& warnings);
std::string picked_text(std::uint32_t sequence, const std::optional<Pick>& pick);
std::string camera_text(ClientId client, const Camera& camera);
std::string clients_text(const std::map<ClientId, std::optional<ClientId>>& following);
std::string histogram_text(const std::vector<Histogram>& histograms);
std::string statistics_text(const Document& document, const RenderStatistics& frame,
                            double encode_ms, std::size_t clients);
std::string listing_text(std::string_view path, const std::vector<FolderEntry>& entries);

}  // namespace motes::server
