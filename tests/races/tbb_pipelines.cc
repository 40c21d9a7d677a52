// SPDX-License-Identifier: GPL-3.0-or-later
// Reports the order of TBB's pipelines to ThreadSanitizer, as tbb_order.cc does for loops and task
// groups: an item's stages follow each other, a serial stage takes one item after the other, the
// first stage begins an item when others have ended, and the pipeline begins before and ends after
// all of them. Parallel stages of different items are not ordered, so that a race between them is
// found.
#include <oneapi/tbb/parallel_pipeline.h>
#include <sanitizer/tsan_interface.h>

#include <new>
#include <vector>

#include "tbb_original.h"

namespace tbb::detail {

namespace {

/// Addresses that events of a pipeline are ordered by.
struct Events {
    char begin, room, end;  ///< of the pipeline; room: for items, where others have ended
};

/// The end of a stage and of the pipeline, also where something is thrown.
struct EndOfStage {
    Events* events;
    ~EndOfStage() { __tsan_release(&events->end); }
};
struct EndOfAll {
    Events* events;
    ~EndOfAll() { __tsan_acquire(&events->end); }
};

/// Value that a stage returns to the next.
struct Item {
    void* content;
};

/// A stage of a pipeline, by way of the one that it stands for.
class Stage final : public d1::base_filter {
  public:
    Stage(d1::base_filter& real, Events& events, bool is_first, bool is_last)
        : base_filter(modeOf(real)),
          real_(&real),
          events_(&events),
          is_first_(is_first),
          is_last_(is_last) {}
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    ~Stage() override {
        __tsan_acquire(&events_->end);
        real_->~base_filter();
        r1::deallocate_memory(real_);
    }

    void* operator()(void* item) override {
        const EndOfStage end{events_};
        __tsan_acquire(&events_->begin);
        if (is_first_) __tsan_acquire(&events_->room);
        if (is_serial()) __tsan_acquire(this);
        at_work = this;
        void* const content = (*real_)(contentOf(item));
        delete static_cast<Item*>(item);  // finalize() if something was thrown
        at_work = nullptr;
        const bool has_ended = has_ended_;
        if (is_serial()) __tsan_release(this);
        if (has_ended) return nullptr;
        if (is_last_) {
            __tsan_release(&events_->room);
            return nullptr;
        }
        Item* const next = new Item{content};
        __tsan_release(next);
        return next;
    }

    /// Destroys remaining values after an exception; by any thread.
    void finalize(void* item) override {
        const EndOfStage end{events_};
        __tsan_acquire(&events_->begin);
        real_->finalize(contentOf(item));
        delete static_cast<Item*>(item);
    }

    /// The stage that this thread is at work for.
    static thread_local Stage* at_work;
    bool has_ended_ = false;

  private:
    static unsigned int modeOf(d1::base_filter& real) {
        return (real.is_serial() ? filter_is_serial : 0) |
               (real.is_ordered() ? 0 : filter_is_out_of_order) |
               (real.object_may_be_null() ? filter_may_emit_null : 0);
    }

    static void* contentOf(void* item) {
        if (item == nullptr) return nullptr;
        __tsan_acquire(item);
        return static_cast<Item*>(item)->content;
    }

    d1::base_filter* real_;
    Events* events_;
    bool is_first_, is_last_;
};

thread_local Stage* Stage::at_work = nullptr;

/// Makes such stages.
class StageNode final : public d1::filter_node {
  public:
    StageNode(const d1::filter_node& real, Events& events, bool is_first, bool is_last)
        : real_(&real), events_(&events), is_first_(is_first), is_last_(is_last) {}
    d1::base_filter* create_filter() const override {
        return new (r1::allocate_memory(sizeof(Stage)))
            Stage(*real_->create_filter(), *events_, is_first_, is_last_);
    }

  private:
    const d1::filter_node* real_;
    Events* events_;
    bool is_first_, is_last_;
};

void addLeaves(const d1::filter_node& node, std::vector<const d1::filter_node*>& leaves) {
    if (!node.left || !node.right) return leaves.push_back(&node);
    addLeaves(*node.left, leaves);
    addLeaves(*node.right, leaves);
}

}  // namespace

namespace r1 {

void set_end_of_input(d1::base_filter&) {
    using SetEnd = void(d1::base_filter&);
    static auto* const real =
        original<SetEnd>("_ZN3tbb6detail2r116set_end_of_inputERNS0_2d111base_filterE");
    Stage::at_work->has_ended_ = true;
    real(*Stage::at_work);
}

void parallel_pipeline(d1::task_group_context& context, std::size_t max_tokens,
                       const d1::filter_node& chain) {
    using Run = void(d1::task_group_context&, std::size_t, const d1::filter_node&);
    static auto* const real = original<Run>(
        "_ZN3tbb6detail2r117parallel_pipelineERNS0_2d118task_group_contextEmRKNS2_11filter_nodeE");
    Events events{};
    std::vector<const d1::filter_node*> leaves;
    addLeaves(chain, leaves);
    d1::filter_node_ptr stages;
    for (const d1::filter_node* leaf : leaves) {
        const d1::filter_node_ptr stage(new (r1::allocate_memory(sizeof(StageNode))) StageNode(
            *leaf, events, leaf == leaves.front(), leaf == leaves.back()));
        stages = stages ? d1::filter_node_ptr(new (r1::allocate_memory(sizeof(d1::filter_node)))
                                                  d1::filter_node(stages, stage))
                        : stage;
    }
    __tsan_release(&events.begin);
    const EndOfAll end{&events};
    real(context, max_tokens, *stages);
}

}  // namespace r1

}  // namespace tbb::detail
