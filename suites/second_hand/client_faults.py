"""The single faults of the client: name | protocols | one sentence.  `fault(name)` is asked at each point of decision."""
from fault_table import FaultTable

# name | C: XGT client, R: Modbus RTU client | one sentence
TABLE = '''
station-decimal | C | the station goes out in decimal digits
station-of-first | CR | all blocks of a case ask the station of the first block in the list
name-cut | C | names of more than 7 characters are cut (length field, too)
name-bit-flat | C | a bit goes out as decimal index of all bits of the area
name-padded | C | names go out as they were entered, with their leading zeros
bcc-byte-loop | C | the loop of the BCC counts in a byte: of frames above 255 bytes only the first (length - 256) are added
bcc-sent-lower | C | the BCC of a request has its letters in lower case
fourth-lost | C | the fourth variable of a single block is not asked
variables-sorted | C | the variables of a single block are asked in the order of their addresses
sb-count-decimal | C | the number of data goes out in decimal
sb-count-bytes | C | the number of data counts bytes, whatever the type
sb-61-lost | C | a run of more than 60 elements asks for 60
write-dword-order | C | a DWord of wSS goes out low word first
write-first-only | C | wSS gives each variable the value of the first one
bit-sent-ff | C | a bit that is on is written as FF
tx-256 | C | a request longer than 256 bytes is not sent
tx-250 | R | a request longer than 250 bytes is cut there
rx-240 | CR | replies of more than 240 bytes are lost
rx-half | CR | replies of more than 128 bytes are lost
count-signed | R | a byte count of 128 and more is taken for negative: such a reply has a wrong length
values-once | CR | the values of a write are taken the first time that its block fires, and never again
values-early | CR | the values of a write are taken when the flag rises, not when the frame goes out
save-delayed | CR | what a reply brings is saved when the next reply of that block comes
save-first-only | C | of a single block only the first variable is saved
save-dword-order | C | a DWord is saved with its words exchanged
save-odd-byte | C | a byte for an odd address is saved at the even one
save-bit-word | CR | saving a bit clears the other bits of its word
save-odd-last | R | of an odd number of words above one the last is not saved
save-bits-byte | R | a run of bits is saved in whole bytes: the padding, too
save-bits-aligned | R | a run of bits is saved from the byte border below its first bit
save-swap-04 | R | words of function 04 are saved low byte first
save-one-more | CR | a run of words is saved with a word more, 0000
save-last-refused | CR | the last word of an area cannot be saved to: 0E
check-ignored | CR | no check is compared
check-first | CR | only the first digit (byte) of the check is compared
check-second | CR | only the second digit (byte) of the check is compared
check-write | CR | the check of the answer to a write is not compared
check-refusal | CR | the check of a refusal is not compared
check-saved | CR | a reply with a wrong check is an error, and saves its values
bcc-case | C | a BCC in the reply is taken as wrong where it has letters
saved-partly | C | a reply that is refused at a later value has saved the earlier ones
refusal-normal | CR | a refusal ends the block as normal
refusal-again | CR | a request that is refused is sent again at once
refusal-stops | CR | a block whose request was refused is not asked again
time-out-again | CR | after a time-out the request is sent once more
error-again | CR | after a reply with a wrong check the request is sent again
time-outs-drop | CR | after three time-outs of a station nothing more is asked of it
reply-station | CR | the station of a reply is not compared
reply-station-low | CR | only the second digit (the low five bits) of the station of a reply is compared
reply-command | CR | the command (function) of a reply is not compared
reply-type | C | the type (SS, SB) of a reply is not compared
reply-type-case | C | a reply with its type in lower case is taken for another command
reply-count | C | the block count of a reply is not looked at
reply-size | CR | the byte count of a reply is not looked at
reply-surplus | CR | surplus behind the values is not looked at
reply-fewer | CR | a reply with fewer values is taken, the rest becomes 0
reply-not-hex | C | what is no hex digit counts as 0
reply-write-data | C | the ACK of a write may have content
reply-echo | R | the address and count that the reply to 0F and 10 repeats are not compared
reply-echo-05 | R | the value that the reply to 05 and 06 repeats is not compared
refusal-length | CR | the length of a refusal is not looked at
time-out-short | CR | the time-out is n x 100 ms instead of (n + 1) x 100 ms
time-out-long | CR | the time-out is (n + 2) x 100 ms
time-out-default | CR | the time-out is 200 ms whatever is set
time-out-first | CR | the time-out is that of the first case
time-out-edge | CR | the time-out counts from the rise of the flag
time-out-bytes | CR | each byte that comes restarts the time-out
time-out-never | CR | without an answer the client waits until the case is over
not-flushed | CR | what came before the request is taken for its answer
split-lost | CR | what is not there at the first look is lost: a reply in two pieces is none
split-next | CR | the first piece of a reply lets the next block ask
gap-short | CR | a pause of 2 ms ends a frame
gap-never | CR | no pause ends a frame: half a frame waits for the time-out
gap-set | CR | the inter-character time that is set is ignored
next-early | CR | a block that is due is asked though the answer to the one before is still out
order-reversed | CR | blocks that fire together are asked from the highest number down
order-lowest | CR | what fires meanwhile does not wait for the next round: the lowest number goes first
order-fired | CR | blocks wait in a queue as they fired, without rounds or numbers
edge-kept | CR | an edge of the block that is under way is kept and asked afterwards
edge-lost | CR | an edge of another block while the line is busy is lost
edge-level | CR | a block whose flag is still on at its end is asked again
edge-both | CR | a flag that falls fires, too
clock-late | CR | the next period of a clock begins when its request goes out, 4 ms late
clock-slow | CR | clocks are slow by a tenth
clock-answer | CR | the next period of a clock begins at the end of the service
clock-catches-up | CR | edges of a clock that were missed are made up for
clock-at-once | CR | the first edge of a clock comes at once
clock-20 | CR | F90 has 40 ms
stop-ignored | CR | blocks ask in STOP
stop-keeps | CR | what waits or is under way at STOP goes on
run-fires | CR | a flag that is on at RUN fires
link-ignored | CR | blocks ask with the link disabled
link-keeps | CR | what waits or is under way when the link is disabled goes on
link-fires | CR | a flag that is on when the link is enabled fires
power-keeps | CR | what waits or is under way goes on behind a power-off
power-clock | CR | a clock keeps its phase over a power-off
over-ignored | CR | what waits for the line when a case is over is asked in the next one
channel-ignored | CR | blocks of the other channel are asked here
delay-ignored | CR | there is no delay time
delay-232 | CR | the delay time holds on RS-232C, too
delay-edge | CR | the delay time counts from the rise of the flag
head-first | C | a reply must begin with its header, noise before it makes the reply lost
noise-ends | C | bytes without a header end the wait
echo-ends | CR | the echo of a request ends the wait as a wrong reply
echo-normal | CR | the echo of a request is taken for its answer, normal
flags-both | CR | NDR stays on behind an error, ERR behind a normal end
status-stays | CR | STATUS stays behind a normal end
count-word | CR | counts have 16 bits
count-errors | CR | errors count as normal ends, too
status-time-out | CR | STATUS of a time-out is 5
request-17 | CR | every 17th request is not sent
skip-after-error | CR | the block behind one that ended with an error is passed over
crc-exception | R | an exception must have the CRC of the function without 80
crc-ends | R | a right CRC ends the frame, what follows is no part of it
address-decimal | R | a Modbus address is read as decimal number
address-byte | R | the high byte of the address is lost
single-1 | R | a continuous write of one element goes out as 05 or 06
bytes-plus | R | function 0F sends (n / 8) + 1 bytes, one too many for multiples of 8
padding-sent | R | the padding of function 0F holds the bits that follow in memory
bits-2000 | R | a run of more than 1992 bits is asked with 1992
words-120 | R | a run of 120 words is asked with 119
function-02 | R | 0x1.... is asked by function 01
function-04 | R | 0x3.... is asked by function 03
write-swap-10 | R | function 10 sends the low byte of each word first
'''
GROUPS = {'C': ('xgt-cnet',), 'R': ('modbus-rtu',), 'CR': ('xgt-cnet', 'modbus-rtu')}

_faults = FaultTable(TABLE, GROUPS)
FAULTS, set_fault, fault = _faults.all, _faults.choose, _faults.fault
