// SPDX-License-Identifier: GPL-3.0-or-later
// Uses internals of Cyclone DDS, see opaque_type.cc.
#include "extensions/ros/module/sample_identity.h"

// This header is no C++: it gives two pointers the names of their structs.
#define Q_SOCKWAITSET_H
using os_sockWaitset = struct SockWaitset*;        // NOLINT(readability-identifier-naming)
using os_sockWaitsetCtx = struct SockWaitsetCtx*;  // NOLINT(readability-identifier-naming)

#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_tran.h>
#include <dds/ddsi/q_misc.h>
#include <dds/ddsi/q_protocol.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

namespace ispace::ros {

namespace {

/// An identity as a parameter: that of DDS-RPC, and that of Fast DDS before version 3, which does
/// not know the former.
constexpr std::uint16_t kRelated = 0x0083, kRelatedOfFast = 0x800f, kIdentitySize = 24;

struct ParameterHead {
    std::uint16_t id, size;
};
constexpr ParameterHead kFirst{kRelated, kIdentitySize}, kEnd{PID_SENTINEL, 0};

constexpr bool kIsLittle = std::endian::native == std::endian::little;

std::uint16_t ordered(std::uint16_t number, bool is_swapped) {
    return is_swapped ? static_cast<std::uint16_t>(number >> 8U | number << 8U) : number;
}

template <typename Value>
void append(std::string& out, const Value& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Reads a packet that lies in several pieces.
class PacketCursor {
  public:
    explicit PacketCursor(std::span<const ddsrt_iovec_t> pieces) : pieces_(pieces) {}

    /// Returns the next bytes; null unless there are so many in one piece.
    [[nodiscard]] std::byte* peek(std::size_t size) {
        while (!pieces_.empty() && at_ >= pieces_.front().iov_len) {
            at_ -= pieces_.front().iov_len;
            pieces_ = pieces_.subspan(1);
        }
        return !pieces_.empty() && size <= pieces_.front().iov_len - at_
                   ? static_cast<std::byte*>(pieces_.front().iov_base) + at_
                   : nullptr;
    }
    void skip(std::size_t size) { at_ += size; }

  private:
    std::span<const ddsrt_iovec_t> pieces_;
    std::size_t at_ = 0;  // in the first piece, or beyond
};

/// Sets the flag of inline parameters for samples whose content begins with kFirst: CDR does not.
void declareIn(PacketCursor packet) {
    packet.skip(sizeof(Header_t));
    while (std::byte* const at = packet.peek(sizeof(SubmessageHeader_t))) {
        SubmessageHeader_t head{};
        std::memcpy(&head, at, sizeof head);
        if (head.submessageId == SMID_DATA && packet.peek(sizeof(Data_t)) != nullptr) {
            PacketCursor content = packet;
            content.skip(sizeof(Data_t));
            const std::byte* const first = content.peek(sizeof kFirst);
            if (first != nullptr && std::memcmp(first, &kFirst, sizeof kFirst) == 0)
                at[offsetof(SubmessageHeader_t, flags)] |= std::byte{DATA_FLAG_INLINE_QOS};
        }
        if (head.octetsToNextHeader == 0) return;  // the last one
        packet.skip(sizeof head + head.octetsToNextHeader);
    }
}

std::atomic<ddsi_tran_write_fn_t> original_send = nullptr;

ssize_t sendDeclared(ddsi_tran_conn_t connection, const ddsi_locator_t* to, std::size_t count,
                     const ddsrt_iovec_t* pieces, std::uint32_t flags) {
    declareIn(PacketCursor(std::span(pieces, count)));
    return original_send.load()(connection, to, count, pieces, flags);
}

}  // namespace

std::optional<DdsRequest> requestOf(const nn_rdata& first) {
    const unsigned char* const packet = NN_RMSG_PAYLOAD(first.rmsg);
    std::size_t at = NN_RDATA_SUBMSG_OFF(&first);
    if (at == 0) return std::nullopt;
    Data_DataFrag_common_t head{};
    std::memcpy(&head, packet + at, sizeof head);  // whose numbers Cyclone has put in order
    if ((head.smhdr.flags & DATA_FLAG_INLINE_QOS) == 0) return std::nullopt;
    const bool is_swapped = ((head.smhdr.flags & SMFLAG_ENDIANNESS) != 0) != kIsLittle;
    at += offsetof(Data_DataFrag_common_t, readerId) + head.octetsToInlineQos;
    const std::size_t end = NN_RDATA_PAYLOAD_OFF(&first);
    while (at + sizeof(ParameterHead) <= end) {
        ParameterHead parameter{};
        std::memcpy(&parameter, packet + at, sizeof parameter);
        at += sizeof parameter;
        const std::uint16_t id = ordered(parameter.id, is_swapped),
                            size = ordered(parameter.size, is_swapped);
        if (id == PID_SENTINEL || size > end - std::min(at, end)) break;
        if ((id == kRelated || id == kRelatedOfFast) && size >= kIdentitySize) {
            DdsRequest out;
            std::copy_n(packet + at, out.reader.size(), out.reader.begin());
            out.number = static_cast<std::int64_t>(fromSN(head.writerSN));
            if (out.reader != DdsGuid{}) return out;
        }
        at += size;
    }
    return std::nullopt;
}

std::string withRequest(const DdsRequest& request, std::string_view message) {
    std::string out;
    for (const std::uint16_t id : {kFirst.id, kRelatedOfFast}) {
        append(out, ParameterHead{id, kIdentitySize});
        append(out, request.reader);
        append(out, toSN(static_cast<seqno_t>(request.number)));
    }
    append(out, kEnd);
    return out.append(message);
}

void declareRequests(ddsi_domaingv* domain) {
    for (int i = 0; i < domain->n_interfaces; ++i) {
        ddsi_tran_write_fn_t& send = domain->xmit_conns[i]->m_write_fn;
        if (send == sendDeclared) continue;
        original_send = send;
        // Threads of Cyclone may read it meanwhile.
        std::atomic_ref(send).store(sendDeclared);
    }
}

}  // namespace ispace::ros
