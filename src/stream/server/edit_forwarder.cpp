// SPDX-License-Identifier: Apache-2.0
#include "stream/server/edit_forwarder.h"

#include <algorithm>

namespace lambent::stream {
namespace {

std::uint32_t input_of(const Edit& edit) {
  return std::visit([](const auto& any) { return any.input; }, edit);
}

}  // namespace

void EditForwarder::add(const Edit& edit, const std::shared_ptr<ClientLink>& from) {
  const std::uint32_t input = input_of(edit);
  for (OnItsWay& one : edits_) {
    if (one.number != 0 || target_of(one.edit) != target_of(edit)) continue;
    one.edit = merged(one.edit, edit);
    const auto known =
        std::find_if(one.senders.begin(), one.senders.end(),
                     [&](const Sender& sender) { return sender.client.lock() == from; });
    if (known != one.senders.end()) {
      known->last = input;
    } else {
      one.senders.push_back({from, input, input});
    }
    return;
  }
  edits_.push_back({edit, {{from, input, input}}, 0, {}, std::nullopt});
}

std::vector<Edit> EditForwarder::due(Clock::time_point now) {
  std::erase_if(edits_, [now](const OnItsWay& one) {
    return one.number != 0 && !one.update && now > one.sent + kPatience;
  });
  const auto sent = [this](const OnItsWay& other) {
    return std::any_of(edits_.begin(), edits_.end(), [&](const OnItsWay& one) {
      return one.number != 0 && !one.update && target_of(one.edit) == target_of(other.edit);
    });
  };
  auto under_way =
      static_cast<std::size_t>(std::count_if(edits_.begin(), edits_.end(), [](const OnItsWay& one) {
        return one.number != 0 && !one.update;
      }));
  std::vector<Edit> now_due;
  for (OnItsWay& one : edits_) {
    if (one.number != 0 || sent(one)) continue;
    if (under_way >= kMaxUnderWay || !rate_.pass(now)) break;
    one.number = ++last_number_;
    one.sent = now;
    std::visit([&](auto& any) { any.input = one.number; }, one.edit);
    now_due.push_back(one.edit);
    ++under_way;
  }
  return now_due;
}

void EditForwarder::applied(const InputsApplied& told) {
  std::vector<std::shared_ptr<ClientLink>> clients;
  for (OnItsWay& one : edits_) {
    if (one.number == 0 || one.number > told.input || one.update) continue;
    one.update = told.update;
    for (const Sender& sender : one.senders) {
      const auto client = sender.client.lock();
      if (!client || !client->wants_light()) continue;
      if (std::find(clients.begin(), clients.end(), client) == clients.end()) {
        clients.push_back(client);
      }
    }
  }
  for (const auto& client : clients) tell_applied(client, told.update);
}

/// Tells a client up to which of its inputs all have been applied.
void EditForwarder::tell_applied(const std::shared_ptr<ClientLink>& client,
                                 std::uint64_t update) const {
  std::uint32_t applied = 0;
  std::optional<std::uint32_t> waits;
  for (const OnItsWay& one : edits_) {
    for (const Sender& sender : one.senders) {
      if (sender.client.lock() != client) continue;
      if (one.update) {
        applied = std::max(applied, sender.last);
      } else {
        waits = std::min(waits.value_or(sender.first), sender.first);
      }
    }
  }
  if (waits) applied = *waits - 1;
  if (applied > 0) client->put_notice(InputsApplied{applied, update});
}

void EditForwarder::lit(std::uint64_t update) {
  std::erase_if(edits_,
                [update](const OnItsWay& one) { return one.update && *one.update <= update; });
}

void EditForwarder::tell(const OnItsWay& one, const std::string& why) {
  for (const Sender& sender : one.senders) {
    if (const auto client = sender.client.lock()) {
      client->put_notice(Refusal{Refusal::Code::refused_input, why.substr(0, kMaxErrorBytes)});
    }
  }
}

void EditForwarder::refused(const std::string& why) {
  for (const OnItsWay& one : edits_) {
    if (one.number != 0 && !one.update) tell(one, why);
  }
}

void EditForwarder::forget(const std::string& why) {
  for (const OnItsWay& one : edits_) tell(one, why);
  edits_.clear();
}

std::uint32_t EditForwarder::shown(const ClientLink& of, std::uint32_t last_input) const {
  std::uint32_t shown = last_input;
  for (const OnItsWay& one : edits_) {
    for (const Sender& sender : one.senders) {
      if (sender.client.lock().get() == &of) shown = std::min(shown, sender.first - 1);
    }
  }
  return shown;
}

}  // namespace lambent::stream
