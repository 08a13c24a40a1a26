"""fenet_check.py --tcp HOST:PORT --udp HOST:PORT: what a FEnet server must do by chapters 5 and 6 of the XBL-EMTA manual, asked by fenet_client.

A line for each check; exit 1 if a server does otherwise.
"""
import argparse
import asyncio
import random
import sys

import fenet_client
from fenet_client import BadReply, Client, Refused, TYPES, READ, COMPANIES

CHANNELS = 4
FAILED = (Refused, BadReply, OSError, EOFError, asyncio.TimeoutError)


def same(got, due, what):
    if got != due:
        raise BadReply(f"{what}: {got} where {due} was written")


async def types(client):
    """X B W D L of 1, 2 and 16 blocks: what is written is read, by its type and as bytes."""
    for letter, (_, size) in TYPES.items():
        for blocks in (1, 2, 16):
            pairs = [(f"%M{letter}{40 + i}", random.randrange(2 if letter == "X" else 256 ** size)) for i in range(blocks)]
            await client.write(pairs)
            values = [value for _, value in pairs]
            same(await client.read(*(name for name, _ in pairs)), values, f"{blocks} of %M{letter}40")
            if letter != "X":
                data = b"".join(value.to_bytes(size, "little") for value in values)
                same(await client.read_block(f"%MB{40 * size}", len(data)), data, f"%M{letter}40 as bytes")


async def bits(client):
    """Bit n of the first word is %MXn, n to 9 (whether the next is %MX10 or %MXA is not printed here)."""
    await client.write([("%MW0", 0x0155)])
    same(await client.read(*(f"%MX{i}" for i in range(10))), [1, 0, 1, 0, 1, 0, 1, 0, 1, 0], "bits of 0x0155")
    await client.write([(f"%MX{i}", i & 1) for i in range(10)])
    same(await client.read("%MW0"), [0x02AA], "word of ten bits")


async def continuous(client):
    for name, count in (("%MB200", 1), ("%MB201", 2), ("%MB201", 255), ("%MB200", 470)):
        data = random.randbytes(count)
        await client.write_block(name, data)
        same(await client.read_block(name, count), data, f"{count} bytes of {name}")
    same(await client.read("%MB200", "%MB669"), [data[0], data[-1]], "first and last byte of a block")


async def data_registers(client):
    """Note 3 of 5.2.4: %DW1234 is %DB2468."""
    await client.write([("%DW1234", 0xA55A)])
    same(await client.read("%DB2468", "%DB2469"), [0x5A, 0xA5], "%DW1234 as bytes")


async def timers(client):
    """Note 1 of 5.2.4: a bit is the contact, bytes and words are the current value."""
    for area in "TC":
        await client.write([(f"%{area}W0", 0)])
        contact = await client.read(f"%{area}X5")
        await client.write([(f"%{area}W0", 0xFFFF * (1 - contact[0]))])
        same(await client.read(f"%{area}X5"), contact, f"contact {area}5 beside the value of {area}0")
        await client.write([(f"%{area}W5", 0x1234)])
        same(await client.read(f"%{area}B10", f"%{area}B11"), [0x34, 0x12], f"value of {area}5 as bytes")


async def invoke_ids(client):
    for invoke in (0, 1, 0x00FF, 0x0100, 0x7FFF, 0xFFFF):
        client.invoke = invoke - 1
        await client.read("%MW100")


async def companies(client):
    for company in COMPANIES.values():
        client.company = company
        await client.write([("%MW100", company[1])])
        same(await client.read("%MW100"), [company[1]], f"word of {company}")
    client.company = COMPANIES["LSIS-XGT"]


async def refused_or_ignored(client, what, body):
    """No request by Table 5-4; the next one is answered all the same."""
    client.invoke = (client.invoke + 1) & 0xFFFF
    client.link.send(fenet_client.frame(client.company, client.invoke, body))
    patience, client.patience = client.patience, 0.3
    try:
        data = await client.answer(body[0], body[2])
        raise BadReply(f"{what} is answered with {data.hex()}")
    except Refused:
        pass
    except asyncio.TimeoutError:
        print(f"note: {what} is not answered")
    finally:
        client.patience = patience
    await client.read("%MW100")


async def limits(client):
    names = [f"%MW{i}" for i in range(17)]
    await client.write([("%MW16", 0x1234)])
    for what, body in {
            "0 blocks": fenet_client.request_body(READ, 2, []),
            "17 blocks": fenet_client.request_body(READ, 2, names),
            "17 blocks to write": fenet_client.request_body(fenet_client.WRITE, 2, names, [b"\xFF\xFF"] * 17),
            "a name of 3 characters": fenet_client.request_body(READ, 2, ["%MW"]),
            "a name of 17 characters": fenet_client.request_body(READ, 2, ["%MW00000000000100"]),
            "a name without %": fenet_client.request_body(READ, 2, ["MW100"]),
            "data type 5": fenet_client.request_body(READ, 5, ["%MW0"]),
            "an end past the area": fenet_client.request_body(READ, 2, ["%MW99999"])}.items():
        await refused_or_ignored(client, what, body)
    same(await client.read("%MW16"), [0x1234], "word of a refused request")


async def single_bytes(client):
    data = fenet_client.frame(client.company, 7, fenet_client.request_body(READ, 2, ["%MW100"]))
    for byte in data:
        client.link.send(bytes([byte]))
        await asyncio.sleep(0.001)
    await client.answer(READ, 2, 7)


async def three_in_a_segment(client):
    requests = [(invoke, fenet_client.request_body(READ, 2, [f"%MW{invoke}"])) for invoke in (100, 101, 102)]
    await client.write([(f"%MW{invoke}", invoke) for invoke, _ in requests])
    client.link.send(b"".join(fenet_client.frame(client.company, *request) for request in requests))
    for invoke, _ in requests:
        same(fenet_client.read_values(await client.answer(READ, 2, invoke), 1, 2), [invoke], "reply of three")


async def reset_after_fin(client):
    """6.3.1 (3): RST ends the connection after the client's FIN."""
    client.link.writer.write_eof()
    try:
        data = await asyncio.wait_for(client.link.reader.read(), client.patience)
        raise BadReply(f"FIN is answered by {'FIN' if data == b'' else data.hex()}, not RST")
    except ConnectionResetError:
        pass


async def served(where):
    """A connection whose first request is answered, or None."""
    try:
        client = await Client.connect(*where)
        await client.read("%MW100")
        return client
    except (OSError, EOFError):
        return None


async def four_connections(where):
    """Four at once, each with words of its own; a fifth is not served; the place of one that leaves is free."""
    clients = [await Client.connect(*where) for _ in range(CHANNELS)]
    for i in range(100):
        await asyncio.gather(*(client.write([(f"%MW{10 * n}", 1000 * n + i)]) for n, client in enumerate(clients)))
        values = await asyncio.gather(*(client.read(f"%MW{10 * n}") for n, client in enumerate(clients)))
        same(values, [[1000 * n + i] for n in range(CHANNELS)], "words of four clients")
    same(await served(where), None, "a fifth connection")
    await reset_after_fin(clients[0])
    fifth = await served(where)
    if fifth is None:
        raise BadReply("the place of a connection that was ended is not free")
    for client in clients + [fifth]:
        await client.link.close()


async def one_memory(tcp, udp):
    async with await Client.connect(*tcp) as stream, await Client.connect(*udp, udp=True) as datagrams:
        await stream.write([("%MW77", 0xBEEF)])
        same(await datagrams.read("%MW77"), [0xBEEF], "word written over TCP")
        await datagrams.write_block("%MB154", b"\x01\x02")
        same(await stream.read("%MW77"), [0x0201], "bytes written over UDP")


ALWAYS = (types, bits, continuous, data_registers, timers, invoke_ids, companies, limits)
STREAMS = (single_bytes, three_in_a_segment, reset_after_fin)


async def conformance(options):
    failures = 0

    async def tried(what, work):
        nonlocal failures
        try:
            await work
            print(f"ok {what}")
        except FAILED as error:
            failures += 1
            print(f"FAIL {what}: {type(error).__name__}: {error}")

    async def alone(check, where, udp):
        async with await Client.connect(*where, udp=udp) as client:
            await check(client)
            stray = await client.link.stray(0.05) if check is not reset_after_fin else b""
            if stray:
                raise BadReply(f"{stray.hex()} though nothing is asked")

    for check in ALWAYS + STREAMS:
        await tried(f"{check.__name__} over TCP", alone(check, options.tcp, False))
    for check in ALWAYS:
        await tried(f"{check.__name__} over UDP", alone(check, options.udp, True))
    await tried("four connections", four_connections(options.tcp))
    await tried("one memory", one_memory(options.tcp, options.udp))
    return failures == 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--tcp", type=fenet_client.address, required=True)
    parser.add_argument("--udp", type=fenet_client.address, required=True)
    sys.exit(0 if asyncio.run(conformance(parser.parse_args())) else 1)


if __name__ == "__main__":
    main()
