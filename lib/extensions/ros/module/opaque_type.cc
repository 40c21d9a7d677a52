// SPDX-License-Identifier: GPL-3.0-or-later
// Uses internals of Cyclone DDS, as rmw_cyclonedds does: they change from version to version.
#include "extensions/ros/module/opaque_type.h"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <dds/version.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <optional>

#include "extensions/ros/module/sample_identity.h"

#if DDS_VERSION_MAJOR != 0 || DDS_VERSION_MINOR != 10
#error "this source was written for Cyclone DDS 0.10"
#endif

namespace ispace::ros {

namespace {

/// A message. Cyclone reads its bytes up to a multiple of four.
struct OpaqueMessage : ddsi_serdata {
    std::string bytes;
    std::uint32_t size = 0;
    std::optional<DdsRequest> request;
};

const OpaqueMessage& own(const ddsi_serdata* message) {
    return *static_cast<const OpaqueMessage*>(message);
}

std::string_view contentOf(const OpaqueMessage& message) {
    return std::string_view(message.bytes).substr(0, message.size);
}

constexpr std::size_t padded(std::size_t size) { return (size + 3) / 4 * 4; }

/// Returns a message of this many bytes, zero so far; null without memory, as C expects.
OpaqueMessage* newMessage(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
    try {
        auto message = std::make_unique<OpaqueMessage>();
        ddsi_serdata_init(message.get(), type, kind);
        message->bytes.resize(padded(size));
        message->size = static_cast<std::uint32_t>(size);
        return message.release();
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

// All messages of a topic are one instance, without a key.

bool equalKeys(const ddsi_serdata* /*a*/, const ddsi_serdata* /*b*/) { return true; }

std::uint32_t sizeOfMessage(const ddsi_serdata* message) { return own(message).size; }

ddsi_serdata* fromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* chain,
                            std::size_t size) {
    if (size > kMaxDdsMessage) return nullptr;
    OpaqueMessage* const message = newMessage(type, kind, size);
    if (message != nullptr) message->request = requestOf(*chain);
    std::uint32_t end = 0;
    for (; message != nullptr && chain != nullptr; chain = chain->nextfrag) {
        // Fragments may overlap.
        const std::uint32_t beyond = std::min(chain->maxp1, message->size);
        if (beyond <= end || chain->min > end) continue;
        const unsigned char* const payload =
            NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_PAYLOAD_OFF(chain));
        std::memcpy(&message->bytes[end], payload + (end - chain->min), beyond - end);
        end = beyond;
    }
    return message;
}

ddsi_serdata* fromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, std::size_t size) {
    if (size > kMaxDdsMessage) return nullptr;
    OpaqueMessage* const message = newMessage(type, kind, size);
    std::size_t end = 0;
    for (ddsrt_msg_iovlen_t i = 0; message != nullptr && i < count && end < size; ++i) {
        const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - end);
        std::memcpy(&message->bytes[end], pieces[i].iov_base, length);
        end += length;
    }
    return message;
}

ddsi_serdata* fromKey(const ddsi_sertype* type, const ddsi_keyhash* /*key*/) {
    return newMessage(type, SDK_KEY, 0);
}

/// Samples are std::string_view.
ddsi_serdata* fromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
    const std::string_view bytes =
        kind == SDK_DATA ? *static_cast<const std::string_view*>(sample) : std::string_view();
    OpaqueMessage* const message = newMessage(type, kind, bytes.size());
    if (message != nullptr) std::copy(bytes.begin(), bytes.end(), message->bytes.begin());
    return message;
}

void copyBytes(const ddsi_serdata* message, std::size_t from, std::size_t size, void* to) {
    std::memcpy(to, own(message).bytes.data() + from, size);
}

ddsi_serdata* lendBytes(const ddsi_serdata* message, std::size_t from, std::size_t size,
                        ddsrt_iovec_t* piece) {
    piece->iov_base = const_cast<char*>(own(message).bytes.data() + from);
    piece->iov_len = size;
    return ddsi_serdata_ref(message);
}

void endLoan(ddsi_serdata* message, const ddsrt_iovec_t* /*piece*/) { ddsi_serdata_unref(message); }

bool toSample(const ddsi_serdata* message, void* sample, void** /*buffer*/, void* /*end*/) {
    *static_cast<std::string_view*>(sample) = contentOf(own(message));
    return true;
}

ddsi_serdata* toUntyped(const ddsi_serdata* message) {
    OpaqueMessage* const key = newMessage(message->type, SDK_KEY, 0);
    if (key != nullptr) key->type = nullptr;
    return key;
}

bool keyToSample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*key*/, void* sample,
                 void** /*buffer*/, void* /*end*/) {
    *static_cast<std::string_view*>(sample) = {};
    return true;
}

void freeMessage(ddsi_serdata* message) { delete static_cast<OpaqueMessage*>(message); }

std::size_t printMessage(const ddsi_sertype* /*type*/, const ddsi_serdata* /*message*/,
                         char* buffer, std::size_t size) {
    if (size > 0) buffer[0] = '\0';
    return 0;
}

void keyHash(const ddsi_serdata* /*message*/, ddsi_keyhash* hash, bool /*md5*/) {
    std::fill(std::begin(hash->value), std::end(hash->value), std::uint8_t{0});
}

const ddsi_serdata_ops kMessageOps = [] {
    ddsi_serdata_ops ops{};
    ops.eqkey = equalKeys;
    ops.get_size = sizeOfMessage;
    ops.from_ser = fromFragments;
    ops.from_ser_iov = fromPieces;
    ops.from_keyhash = fromKey;
    ops.from_sample = fromSample;
    ops.to_ser = copyBytes;
    ops.to_ser_ref = lendBytes;
    ops.to_ser_unref = endLoan;
    ops.to_sample = toSample;
    ops.to_untyped = toUntyped;
    ops.untyped_to_sample = keyToSample;
    ops.free = freeMessage;
    ops.print = printMessage;
    ops.get_keyhash = keyHash;
    return ops;
}();

void freeType(ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
}

void zeroSamples(const ddsi_sertype* /*type*/, void* samples, std::size_t count) {
    std::fill_n(static_cast<std::string_view*>(samples), count, std::string_view());
}

void reallocateSamples(void** pointers, const ddsi_sertype* /*type*/, void* old,
                       std::size_t old_count, std::size_t count) {
    auto* const samples =
        static_cast<std::string_view*>(dds_realloc(old, count * sizeof(std::string_view)));
    for (std::size_t i = 0; i < count; ++i) {
        if (i >= old_count) new (samples + i) std::string_view();
        pointers[i] = samples + i;
    }
}

void freeSamples(const ddsi_sertype* /*type*/, void** pointers, std::size_t count,
                 dds_free_op_t op) {
    if (count > 0 && (op & DDS_FREE_ALL_BIT) != 0) dds_free(pointers[0]);
}

/// The names are the same already.
bool equalTypes(const ddsi_sertype* /*a*/, const ddsi_sertype* /*b*/) { return true; }
std::uint32_t hashOfType(const ddsi_sertype* /*type*/) { return 0; }

const ddsi_sertype_ops kTypeOps = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    ops.free = freeType;
    ops.zero_samples = zeroSamples;
    ops.realloc_samples = reallocateSamples;
    ops.free_samples = freeSamples;
    ops.equal = equalTypes;
    ops.hash = hashOfType;
    return ops;
}();

}  // namespace

ddsi_sertype* newOpaqueType(const std::string& name) {
    auto* const type = new ddsi_sertype{};
    ddsi_sertype_init_flags(type, name.c_str(), &kTypeOps, &kMessageOps,
                            DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
    type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
    return type;
}

ddsi_serdata* newOpaqueMessage(const ddsi_sertype* type, std::string_view bytes) {
    ddsi_serdata* const message = fromSample(type, SDK_DATA, &bytes);
    if (message == nullptr) throw std::bad_alloc();
    return message;
}

DdsMessage messageOf(const ddsi_serdata* message) {
    return {std::string(contentOf(own(message))), own(message).request};
}

}  // namespace ispace::ros
