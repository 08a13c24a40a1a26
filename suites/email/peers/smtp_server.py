"""An SMTP server (Debian's python3-aiosmtpd) that takes mails and prints each as a line of JSON.

usage: smtp_server.py PORT [--refuse ADDRESS]

Listens on 127.0.0.1 and prints "listening" first. A recipient that is to be refused draws 550.
"""

import argparse
import asyncio
import email
import json

from aiosmtpd.smtp import SMTP


class Mailboxes:
    def __init__(self, refused):
        self.refused = refused

    async def handle_RCPT(self, server, session, envelope, address, options):
        if address == self.refused:
            return "550 no such mailbox"
        envelope.rcpt_tos.append(address)
        return "250 OK"

    async def handle_DATA(self, server, session, envelope):
        message = email.message_from_bytes(envelope.content)
        print(json.dumps({
            "host": session.host_name,
            "sender": envelope.mail_from,
            "recipients": envelope.rcpt_tos,
            "from": message["From"],
            "reply_to": message["Reply-To"],
            "to": message["To"],
            "subject": message["Subject"],
            "text": message.get_payload(),
        }, sort_keys=True), flush=True)
        return "250 taken"


async def serve(port, refused):
    loop = asyncio.get_running_loop()
    server = await loop.create_server(
        lambda: SMTP(Mailboxes(refused), hostname="mail.plant.example"), "127.0.0.1", port)
    print("listening", flush=True)
    await server.serve_forever()


parser = argparse.ArgumentParser()
parser.add_argument("port", type=int)
parser.add_argument("--refuse", default="")
arguments = parser.parse_args()
asyncio.run(serve(arguments.port, arguments.refuse))
