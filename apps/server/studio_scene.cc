// What the studio shows: opening, edits, frames.
#include <new>
#include <utility>

#include "core/error.h"
#include "server/answers.h"
#include "server/files.h"
#include "server/studio.h"

namespace motes::server {
namespace {

constexpr const char* cancelled_text = "cancelled";

/// Calls work(); what goes wrong with files and scenes becomes text, and that it was cancelled.
template <class Work>
std::optional<std::string> error_of(const Work& work) {
  try {
    work();
    return {};
  } catch (const Error& error) {
    return error.what();
  } catch (const Cancelled&) {
    return cancelled_text;
  } catch (const std::bad_alloc&) {
    return "not enough memory";
  }
}

}  // namespace

void Studio::open(Opening opening) {
  post([this, opening = std::move(opening)] { start_opening(opening); }, false);
}

void Studio::start_opening(const Opening& opening) {
  loader_.cancel();
  const std::uint64_t number = ++opening_;
  loader_.add([this, opening, number](const std::atomic<bool>& cancelled) {
    LoadProgress progress(
        [this](std::string_view activity, double fraction) {
          post([this, text = progress_text(activity, fraction)] { send_to_all(text); }, false);
        },
        cancelled);
    std::shared_ptr<Document> document;
    bool fitted = false;
    Warnings warnings;
    const auto error = error_of([&] {
      progress.update("opening " + opening.name, 0);
      Scene scene = opening.scene();
      fitted = !scene.eye && !scene.target;
      {
        const std::lock_guard lock(mutex_);
        opening_files_ = files_of(scene);
      }
      document = std::make_shared<Document>(
          Document::open(opening.name, std::move(scene), &progress, warnings));
    });
    post(
        [this, opening, number, document, fitted, warnings, error] {
          if (number == opening_) {
            if (document) fitted_ = fitted;
            end_opening(opening, document, error, warnings);
          } else if (opening.failed) {
            opening.failed({});  // something else has been asked for since
          }
        },
        true);
  });
}

void Studio::end_opening(const Opening& opening, std::shared_ptr<Document> document,
                         const std::optional<std::string>& error, const Warnings& warnings) {
  {
    const std::lock_guard lock(mutex_);
    opening_files_.clear();
  }
  const bool cancelled = error == cancelled_text;
  if (document) adopt(opening, std::move(document), warnings);
  if (error && opening.failed) opening.failed(cancelled ? std::nullopt : error);
  if (error && !cancelled) {
    if (!document_) opening_error_ = *error;
    send_to_all(error_text(opening.sequence, *error));
  }
  send_to_all(ready_text());
}

std::vector<std::filesystem::path> Studio::files_in_use() {
  const std::lock_guard lock(mutex_);
  std::vector<std::filesystem::path> files = shown_files_;
  files.insert(files.end(), opening_files_.begin(), opening_files_.end());
  return files;
}

void Studio::document_has_changed() {
  ++version_;
  const std::lock_guard lock(mutex_);
  shown_files_ = files_of(document_->scene());
}

void Studio::adopt(const Opening& opening, std::shared_ptr<Document> document,
                   const Warnings& warnings) {
  document_ = std::move(document);
  document_has_changed();
  // Grids do not move.
  frames_ = document_->info().particles == 0 ? std::optional<std::size_t>(1) : std::nullopt;
  if (!document_->info().path.empty()) {
    reader_ = std::make_shared<FrameReader>(document_->frame_reader());
  }
  prefetched_.reset();
  prefetching_.reset();
  lookahead_.cancel();
  for (auto& [id, viewer] : viewers_) {
    viewer.look_anew(document_->camera());
    if (opening.client == id && opening.sequence) viewer.took_scene(*opening.sequence);
  }
  send_scene({opening.client, opening.sequence, !opening.sequence, fitted_});
  send_warnings(warnings);
  count_frames();
}

void Studio::count_frames() {
  if (frames_) return;
  lookahead_.add([this, reader = reader_, number = opening_](const std::atomic<bool>& cancelled) {
    LoadProgress progress([](std::string_view, double) {}, cancelled);
    if (error_of([&] { reader->count_frames(&progress); })) return;
    post(
        [this, number, frames = *reader->num_frames()] {
          if (number != opening_) return;
          frames_ = frames;
          send_scene({});
        },
        false);
  });
}

void Studio::set_scene(ClientId client, std::uint32_t sequence, Scene scene) {
  post_for(
      client,
      [this, client, sequence, scene = std::move(scene)](Viewer&) {
        change_scene(client, sequence, scene);
      },
      true);
}

void Studio::change_scene(ClientId client, std::uint32_t sequence, const Scene& scene) {
  if (!document_ || document_->shows_other_data(scene)) {
    return start_opening(
        {scene.data_path.filename().string(), [scene] { return scene; }, client, sequence});
  }
  const std::uint64_t frame_before = document_->scene().frame;
  Warnings warnings;
  LoadProgress progress([this](std::string_view activity,
                               double fraction) { send_to_all(progress_text(activity, fraction)); },
                        cancel_edit_);
  cancel_edit_ = false;
  const auto error = error_of([&] {
    if (prefetched_ && prefetched_->frame == scene.frame && scene.frame != frame_before) {
      ParticleSet particles = std::move(prefetched_->particles);
      prefetched_.reset();
      document_->set_scene(scene, std::move(particles), &progress, warnings);
    } else {
      document_->set_scene(scene, &progress, warnings);
    }
  });
  if (progress.has_reported()) send_to_all(ready_text());
  if (error) return viewers_.at(client).outlet().send_text(error_text(sequence, *error));
  fitted_ = false;  // edits bring the camera of who makes them
  document_has_changed();
  for (auto& [id, viewer] : viewers_) viewer.invalidate();
  viewers_.at(client).took_scene(sequence);
  send_scene({client, sequence});
  send_warnings(warnings);
  if (scene.frame != frame_before) prefetch(2 * scene.frame - frame_before);
}

void Studio::prefetch(std::uint64_t frame) {
  if (!frames_ || prefetching_ == frame) return;
  if (frame >= *frames_) frame = 0;  // a loop begins anew
  prefetching_ = frame;
  lookahead_.cancel();
  lookahead_.add(
      [this, reader = reader_, frame, number = opening_](const std::atomic<bool>& cancelled) {
        LoadProgress progress([](std::string_view, double) {}, cancelled);
        Warnings warnings;
        auto particles = std::make_shared<ParticleSet>();
        if (error_of([&] { *particles = reader->read_frame(frame, &progress, warnings); })) {
          return;  // told when it is really wanted
        }
        post(
            [this, frame, particles, number] {
              if (number == opening_) prefetched_ = Prefetched{frame, std::move(*particles)};
            },
            false);
      });
}

}  // namespace motes::server
