// What clients ask of the studio.
#include <algorithm>
#include <utility>

#include "core/error.h"
#include "server/answers.h"
#include "server/studio.h"

namespace motes::server {
namespace {

/// Messages that change what is seen, or whose answer somebody waits for.
bool is_pressing(const Message& message) {
  return !std::holds_alternative<AckMessage>(message) &&
         !std::holds_alternative<StatisticsMessage>(message) &&
         !std::holds_alternative<HistogramMessage>(message);
}

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

}  // namespace

void Studio::connect(ClientId client, std::shared_ptr<Outlet> outlet) {
  post(
      [this, client, outlet = std::move(outlet)] {
        Viewer& viewer = viewers_.emplace(client, outlet).first->second;
        if (document_) {
          viewer.look_anew(document_->camera());
          viewer.outlet().send_text(scene_text(*document_, frames_, {.fitted = fitted_}));
        } else if (!opening_error_.empty()) {
          viewer.outlet().send_text(error_text({}, opening_error_));
        }
        send_clients();
      },
      true);
}

void Studio::disconnect(ClientId client) {
  post(
      [this, client] {
        if (viewers_.erase(client) == 0) return;
        for (auto& [id, viewer] : viewers_) {
          if (viewer.following() == client) viewer.follow({});
        }
        send_clients();
      },
      false);
}

void Studio::handle(ClientId client, const Message& message) {
  if (std::holds_alternative<CancelMessage>(message)) {
    loader_.cancel();
    cancel_edit_ = true;
  }
  if (const auto* ack = std::get_if<AckMessage>(&message)) {
    // Timed here: the studio may be busy.
    return post_for(
        client, [frame = ack->frame, now = Clock::now()](Viewer& v) { v.acknowledged(frame, now); },
        false);
  }
  post_for(
      client, [this, client, message](Viewer& viewer) { answer(client, viewer, message); },
      is_pressing(message));
}

void Studio::answer(ClientId client, Viewer& viewer, const Message& message) {
  const auto only_with_document = [this](auto&& work) {
    if (document_) work();
  };
  std::visit(
      Overloaded{
          [&](const SizeMessage& m) { viewer.resize(m.width, m.height); },
          [&](const ViewMessage& m) {
            viewer.took_view(m.sequence);
            if (viewer.following()) {
              viewer.follow({});
              send_clients();
            }
            look(client, m.camera, m.moving);
          },
          [&](const PickMessage& m) {
            only_with_document([&] {
              const auto hit =
                  document_->pick(viewer.camera(), viewer.width(), viewer.height(), m.x, m.y);
              viewer.outlet().send_text(picked_text(m.sequence, hit));
            });
          },
          [&](const FitMessage&) {
            only_with_document([&] {
              const double aspect =
                  viewer.width() > 0 ? static_cast<double>(viewer.width()) / viewer.height() : 1;
              viewer.outlet().send_text(camera_text(client, document_->fit(aspect)));
            });
          },
          [&](const HistogramMessage&) {
            const bool waits =
                std::any_of(histograms_.begin(), histograms_.end(),
                            [client](const WantedHistogram& h) { return h.client == client; });
            if (!waits) histograms_.push_back({client});
          },
          [&](const StatisticsMessage&) {
            only_with_document([&] {
              viewer.outlet().send_text(
                  statistics_text(*document_, statistics_, viewer.encode_ms(), viewers_.size()));
            });
          },
          [&](const FollowMessage& m) {
            const auto followed = m.client ? viewers_.find(*m.client) : viewers_.end();
            const bool possible = followed != viewers_.end() && *m.client != client;
            viewer.follow(possible ? m.client : std::nullopt);
            if (possible) {
              viewer.look(followed->second.camera(), false, Clock::now());
              viewer.outlet().send_text(camera_text(*m.client, viewer.camera()));
            }
            send_clients();
          },
          [&](const CancelMessage&) { send_to_all(ready_text()); },
          [](const auto&) {}},  // what is about files does not come here
      message);
}

void Studio::look(ClientId client, const Camera& camera, bool moving) {
  const auto now = Clock::now();
  for (auto& [id, viewer] : viewers_) {
    if (id != client && viewer.following() != client) continue;
    viewer.look(camera, moving, now);
    if (id != client) viewer.outlet().send_text(camera_text(client, camera));
  }
}

}  // namespace motes::server
