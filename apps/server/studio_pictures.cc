// What takes long: histograms, and pictures to be saved, piece by piece.
#include <algorithm>
#include <atomic>
#include <exception>
#include <utility>

#include "core/report.h"
#include "image/write_image.h"
#include "server/answers.h"
#include "server/studio.h"

namespace motes::server {
namespace {

/// What was broken off so often insists.
constexpr int patience = 3;
/// A picture that was begun anew more often is given up.
constexpr int max_restarts = 2 * patience;

}  // namespace

bool Studio::do_long_task() {
  if (!histograms_.empty()) {
    WantedHistogram wanted = histograms_.front();
    histograms_.pop_front();
    const auto viewer = viewers_.find(wanted.client);
    if (document_ && viewer != viewers_.end()) make_histogram(viewer->second, wanted);
    return true;
  }
  if (pictures_.empty() || encoding_) return false;
  go_on_with_picture();
  return true;
}

void Studio::make_histogram(Viewer& viewer, WantedHistogram& wanted) {
  const bool insists = wanted.broken_off == patience;
  if (!begin(insists ? UnderWay::insisting : UnderWay::resting)) {
    return histograms_.push_front(wanted);
  }
  try {
    viewer.outlet().send_text(histogram_text(document_->histogram(
        viewer.camera(), std::max(viewer.width(), 1), std::max(viewer.height(), 1), &break_off_)));
  } catch (const Cancelled&) {
    wanted.broken_off = insists ? 0 : wanted.broken_off + 1;
    histograms_.push_front(wanted);
  } catch (const std::exception& error) {
    viewer.outlet().send_text(error_text({}, error.what()));
  }
  end();
}

bool Studio::prepare_picture(PictureJob& job) {
  if (*job.request.abandoned) return false;
  const auto viewer = viewers_.find(job.request.client);
  if (!document_ || viewer == viewers_.end()) {
    job.answer({}, "there is nothing to be seen");
    return false;
  }
  if (job.version == version_) return true;
  // What has been rendered so far shows another scene.
  if (job.version != 0 && ++job.restarts > max_restarts) {
    job.answer({}, "the scene was changed again and again before the picture was done");
    return false;
  }
  job.version = version_;
  job.camera = viewer->second.camera();
  job.tiles_done.clear();
  return true;
}

void Studio::go_on_with_picture() {
  const std::shared_ptr<PictureJob> job = pictures_.front();
  if (!prepare_picture(*job)) return pictures_.pop_front();
  if (!begin(job->restarts < patience ? UnderWay::resting : UnderWay::insisting)) return;
  try {
    const PictureRequest& request = job->request;
    document_->render(job->camera, request.width, request.height, {}, &break_off_, job->image,
                      nullptr, &job->tiles_done);
    pictures_.pop_front();
    encode(job);
  } catch (const Cancelled&) {
    // What is done of it stays.
  } catch (const std::exception& error) {  // Error, or not enough memory
    pictures_.pop_front();
    job->answer({}, error.what());
  }
  end();
}

void Studio::encode(std::shared_ptr<PictureJob> job) {
  encoding_ = std::move(job);
  const RenderSettings& settings = document_->scene().render;
  encoder_->add([this, job = encoding_, opacity = settings.termination_opacity,
                 background = settings.background](const std::atomic<bool>& /*cancelled*/) {
    const PictureRequest& request = job->request;
    try {
      job->answer(
          encode_image(request.format, job->image, opacity, background, request.abandoned.get()),
          "");
    } catch (const Cancelled&) {
      // Nobody waits for it.
    } catch (const std::exception& error) {
      job->answer({}, error.what());
    }
    post([this] { encoding_.reset(); }, false);
  });
}

void Studio::picture(const PictureRequest& request, PictureAnswer answer) {
  post(
      [this, request, answer = std::move(answer)] {
        auto job = std::make_shared<PictureJob>();
        job->request = request;
        job->answer = answer;
        pictures_.push_back(std::move(job));
      },
      false);
}

void Studio::abandon(const PictureRequest& request) {
  *request.abandoned = true;
  post([] {}, true);
}

}  // namespace motes::server
