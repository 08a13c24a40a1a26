"""FEnet servers under load and under clients that behave badly, by fenet_client; each prints one line of JSON, exit 1 if it finds fault.

fenet_load.py load --tcp HOST:PORT [--clients 4] [--seconds 2]   all at full speed: replies lost, crossed, late
fenet_load.py flood --tcp HOST:PORT [--connections 1000]         connections at once: how many are served
fenet_load.py loris --tcp HOST:PORT                              silent half requests beside a client at work
fenet_load.py starve --tcp HOST:PORT [--seconds 60]              half requests on all channels, until a client is served
"""
import argparse
import asyncio
import json
import resource
import struct
import sys
import time

import fenet_client
from fenet_client import BadReply, Client, READ, COMPANIES
from fenet_check import CHANNELS, FAILED, same, served


async def load(options):
    """Each client writes and reads its own words as fast as it can: a lost reply is late by its patience, a crossed one has other words or
    another invoke ID, a late one comes when nothing is asked."""
    counts = {"exchanges": 0, "lost": 0, "crossed": 0, "late": 0, "slowest_ms": 0.0}
    end = time.monotonic() + options.seconds

    async def timed(request):
        began = time.monotonic()
        found = await request
        counts["exchanges"] += 1
        counts["slowest_ms"] = max(counts["slowest_ms"], round(1000 * (time.monotonic() - began), 1))
        return found

    async def work(number):
        async with await Client.connect(*options.tcp) as client:
            own = [f"%MW{200 * number + i}" for i in range(16)]
            turn = 0
            while time.monotonic() < end:
                turn += 1
                values = [(number << 14 | turn + i) & 0xFFFF for i in range(16)]
                await timed(client.write(list(zip(own, values))))
                same(await timed(client.read(*own)), values, "words")
                data = struct.pack("<16H", *values)
                same(await timed(client.read_block(f"%MB{400 * number}", 32)), data, "bytes")
            counts["late"] += bool(await client.link.stray(0.2))

    for done in await asyncio.gather(*(work(n) for n in range(options.clients)), return_exceptions=True):
        if isinstance(done, BadReply):
            counts["crossed"] += 1
        elif done:
            counts["lost"] += 1
        if done:
            print(f"{type(done).__name__}: {done}", file=sys.stderr)
    counts["per_second"] = round(counts["exchanges"] / options.seconds)
    print(json.dumps(counts))
    return not (counts["lost"] or counts["crossed"] or counts["late"])


async def flood(options):
    """All connect at once and ask; those that are served stay until every other one has been decided."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, min(hard, options.connections + 100)), hard))
    counts = {"served": 0, "reset": 0, "ended": 0, "silent": 0}
    decided = asyncio.Event()

    async def outcome():
        client = await Client.connect(*options.tcp, patience=60)
        try:
            await client.read("%MW100")
            return client, "served"
        except ConnectionResetError:
            return client, "reset"
        except EOFError:
            return client, "ended"
        except asyncio.TimeoutError:
            return client, "silent"

    async def one():
        try:
            client, what = await outcome()
        except ConnectionError:  # before it was made
            client, what = None, "reset"
        counts[what] += 1
        if sum(counts.values()) == options.connections:
            decided.set()
        await decided.wait()
        if client:
            await client.link.close()

    await asyncio.gather(*(one() for _ in range(options.connections)))
    print(json.dumps(counts))
    return counts["served"] == CHANNELS and counts["reset"] == options.connections - CHANNELS


WHOLE = fenet_client.frame(COMPANIES["LSIS-XGT"], 1, fenet_client.request_body(READ, 2, ["%MW100"]))


async def loris(options):
    """Half a header and silence, a header and half a body, a byte now and then; the fourth client asks all the while."""
    slow = [await Client.connect(*options.tcp) for _ in range(CHANNELS - 1)]
    slow[0].link.send(WHOLE[:10])
    slow[1].link.send(WHOLE[:25])
    counts = {"exchanges": 0, "slow_served": 0}
    async with await Client.connect(*options.tcp) as client:
        for i in range(1000):
            if i % 50 == 0:
                slow[2].link.send(WHOLE[i // 50:i // 50 + 1])
            await client.write([("%MW100", i)])
            same(await client.read("%MW100"), [i], "word beside slow clients")
            counts["exchanges"] += 2
    for client, sent in zip(slow, (10, 25, 20)):
        client.link.send(WHOLE[sent:])
        same(fenet_client.read_values(await client.answer(READ, 2, 1), 1, 2), [999], "word of a slow client")
        counts["slow_served"] += 1
        await client.link.close()
    print(json.dumps(counts))
    return True


async def starve(options):
    """Half headers on all channels are no requests: when the reception waiting time is over their places are free (6.2.2)."""
    slow = [await Client.connect(*options.tcp) for _ in range(CHANNELS)]
    for one in slow:
        one.link.send(WHOLE[:10])
    refused = 0
    end = time.monotonic() + options.seconds
    while (client := await served(options.tcp)) is None and time.monotonic() < end:
        refused += 1
        await asyncio.sleep(0.05)
    print(json.dumps({"refused": refused, "served": client is not None}))
    if client:
        await client.link.close()
    for one in slow:
        await one.link.close()
    return client is not None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["load", "flood", "loris", "starve"])
    parser.add_argument("--tcp", type=fenet_client.address, required=True)
    parser.add_argument("--clients", type=int, default=CHANNELS)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--connections", type=int, default=1000)
    options = parser.parse_args()
    if options.seconds is None:
        options.seconds = 60 if options.what == "starve" else 2
    try:
        sys.exit(0 if asyncio.run(globals()[options.what](options)) else 1)
    except FAILED as error:
        sys.exit(f"fenet_load: {type(error).__name__}: {error}")


if __name__ == "__main__":
    main()
