// Reads flight.mcap with the readers of Foxglove, by its index and from its start, and prints what is in it.
//   npm install @mcap/core@2.2.2 @foxglove/rosmsg @foxglove/rosmsg2-serialization @foxglove/wasm-zstd
//   node read_flight_mcap.mjs out/flight.mcap
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import fs from "node:fs";

await zstd.isLoaded;
const decompressHandlers = { zstd: (data, size) => zstd.decompress(data, Number(size)) };
const bytes = fs.readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};

function shown(value) {
  if (value instanceof Uint8Array) return `${value.length} bytes`;
  return JSON.stringify(value, (_, one) => {
    if (ArrayBuffer.isView(one)) return one.length > 12 ? `${one.length} numbers` : Array.from(one);
    if (Array.isArray(one) && one.length > 6) return `${one.length} elements`;
    return one;
  });
}

const schemas = new Map();
const channels = new Map();
const counts = new Map();
function take(record) {
  if (record.type === "Schema") schemas.set(record.id, record);
  if (record.type === "Channel") channels.set(record.id, record);
  if (record.type !== "Message") return;
  const { topic, schemaId } = channels.get(record.channelId);
  const schema = schemas.get(schemaId);
  const reader = new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true }));
  const message = reader.readMessage(record.data);
  if (!counts.has(topic)) console.log(`${topic} (${schema.name})\n  ${shown(message).slice(0, 400)}`);
  counts.set(topic, (counts.get(topic) ?? 0) + 1);
}

const stream = new McapStreamReader({ decompressHandlers, validateCrcs: true });
stream.append(bytes);
for (let record; (record = stream.nextRecord()); ) take(record);
console.log("from the start:", Object.fromEntries(counts));
try {
  const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  let messages = 0;
  for await (const _ of indexed.readMessages()) ++messages;
  console.log(`by the index: ${messages} messages in ${indexed.chunkIndexes.length} chunks, profile ${indexed.header.profile}`);
  console.log(`statistics: ${indexed.statistics.messageCount} messages, ${indexed.statistics.channelCount} channels`);
} catch (error) {
  console.log(`by the index: ${error.message}`);
}
