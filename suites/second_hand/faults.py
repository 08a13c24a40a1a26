"""The single faults: name | protocols | one sentence.  `fault(name)` is asked at each point of decision."""
from fault_table import FaultTable

C, F = 'xgt-cnet', 'xgt-fenet'
R, A, T = 'modbus-rtu', 'modbus-ascii', 'modbus-tcp'
L = 'ls-bus'
GROUPS = {'CF': (C, F), 'C': (C,), 'F': (F,), 'R': (R,), 'A': (A,), 'T': (T,), 'RAT': (R, A, T),
          'RA': (R, A), 'ALL': (C, R, A, T, F), 'TF': (T, F), 'L': (L,)}

TABLE = '''
mem-d-alias | CF | address bit 13 of D words is dropped: D8192 and up are D0 and up
mem-m-alias | ALL | address bit 9 of M words is dropped: M512 and up are M0 and up
mem-r-high-in-d | CF | R10000 and up share their memory with D10000 and up
mem-k-short | CF | K ends at K2559, as on the S type
mem-l-short | CF | L ends at L1279, as on the S type
mem-n-short | CF | N ends at N3935, as on the S type
mem-u-short | CF | U ends at U07.31 (word 255), as on the S type
mem-d-last-refused | CF | the last word of D, D10239, is refused
mem-c-one-more | CF | C1024, one past the end, is accepted
mem-t-contact-value | CF | the contact of a timer reads as current value other than zero
mem-c-contact-count | CF | writing a counter contact also clears its current value
mem-k-odd-byte | CF | an odd byte of K reads the even byte of its word
mem-dword-write-order | CF | a DWord is written with its words exchanged, reading is right
mem-lword-read-order | CF | an LWord is read with its two DWords exchanged
mem-l-bits-flat | CF | bit names of L are a flat decimal index, as on XEC
mem-bit-lower-digit | CF | a bit digit a-f in lower case is refused as malformed
mem-bit-high-byte | ALL | writing a bit 8-F by itself clears the low byte of its word
mem-read-after-bit | ALL | the first read of a word after a bit write of that word gives the old value
mem-f-writable | CF | F can be written
mem-n-writable | CF | N can be written
mem-r-missing | CF | R is not served, as on the S type
mem-range-start-only | CF | a run of elements is checked for its first address only
mem-u-bit-page | CF | a bit of U in words 320 and up (module 0A) goes to module 00
mem-t-byte-limit | CF | bytes of T are counted like words: TB1024 and up are out of range
cnet-bcc-low-digit | C | only the second digit of the BCC is compared
cnet-bcc-ignored-y | C | the BCC of y is not compared
cnet-bcc-ignored-wsb | C | the BCC of wSB is not compared
cnet-bcc-nak-no-head | C | the BCC of a NAK leaves out the header byte
cnet-bcc-reply-lower | C | a BCC sent with letters is in lower case
cnet-bcc-case | C | a received BCC in lower-case digits is taken as wrong
cnet-bcc-missing | C | a lower-case frame that stops after EOT is served when the gap comes
cnet-bcc-after-nak | C | the reply after a NAK has a BCC one too high
cnet-upper-wsb-bcc | C | the reply to an upper-case WSB carries a BCC
cnet-upper-y-lower | C | the reply to Y repeats the command as y
cnet-nak-upper | C | the NAK to w is sent as W, without BCC
cnet-station-00 | C | station 00 is answered like a broadcast
cnet-station-ff | C | station FF is answered
cnet-station-low-digit | C | only the second digit of the station is compared
cnet-noise-kills | C | noise before ENQ makes the frame lost
cnet-enq-no-restart | C | ENQ inside a frame does not restart it
cnet-second-dropped | C | of two requests back to back the second is lost
cnet-gap-joined | C | a gap inside a frame is not seen, the halves are joined
cnet-buffer-256 | C | frames of more than 256 bytes are lost
cnet-buffer-512 | C | frames of more than 512 bytes are lost
cnet-etx-tail | C | ETX is taken as tail of a request too
cnet-type-lower | C | the command type in lower case (ss, sb) is not known: silence
cnet-unknown-nak | C | an unknown command type is answered with NAK 0011
cnet-17th-silent | C | every 17th request is not answered
cnet-long-then-ack | C | the ACK of a write after a reply of more than 200 bytes carries two stale characters
cnet-count-16-refused | C | 16 blocks in rSS are refused
cnet-count-17-wss | C | 17 blocks in wSS are accepted
cnet-count-0-rss | C | 00 blocks in rSS are answered with 00 blocks
cnet-count-0-code | C | 00 blocks are refused with 0003
cnet-count-decimal | C | the block count is read as decimal, so 10 means ten
cnet-sb-61 | C | rSB serves 61 words
cnet-wsb-60-refused | C | wSB of the full 120 bytes is refused
cnet-sb-bytes-60 | C | rSB of bytes is limited to 60 elements
cnet-sb-dword-60 | C | rSB of DWords is limited to 60 elements, not to 120 bytes
cnet-sb-0 | C | rSB of 00 elements is acknowledged
cnet-sb-limit-code | C | an SB write above 60 words is refused with 7132
cnet-x-blocks-code | C | 17 blocks in a registration are refused with 0011
cnet-sb-end-code | C | an SB run past the end of the area is refused with 1132
cnet-mixed-read | C | blocks of different types are accepted in rSS
cnet-mixed-write | C | blocks of different types are accepted in wSS
cnet-surplus-rss | C | surplus characters behind rSS are accepted
cnet-surplus-wsb | C | surplus characters behind wSB are accepted
cnet-surplus-y | C | surplus characters behind y are accepted
cnet-surplus-code | C | surplus characters are refused with 0011
cnet-wss-partial | C | a wSS refused at a later block has written the earlier ones
cnet-wsb-partial | C | a wSB past the end writes what fits before its NAK
cnet-wss-16th-lost | C | the 16th block of wSS is acknowledged, not written
cnet-bit-value | C | a bit value other than 00 and 01 is written as 1
cnet-bit-value-code | C | a wrong bit value is refused with 1432
cnet-data-lower | C | data digits a-f in lower case are refused with 1432
cnet-data-half-checked | C | only the first two digits of each element of wSB are checked for hex
cnet-name-lower | C | device letters in lower case are refused with 1132
cnet-name-16-refused | C | names of 16 characters are refused
cnet-name-17 | C | names of 17 characters are accepted
cnet-name-0-code | C | name length 00 is refused with 0011
cnet-percent-any | C | a name may start with any character
cnet-type-code | C | an unknown type letter is refused with 1132
cnet-hex-word | C | hex letters in a word number are read as hex
cnet-hex-word-code | C | hex letters in a word number are refused with 0011
cnet-sb-bit-bytes | C | rSB of bits is served
cnet-rsb-dword-order | C | rSB sends the low word of a DWord first, rSS is right
cnet-rsb-dword-count | C | the byte count of rSB for DWords is the number of elements
cnet-rsb-odd-tail | C | the last byte of an rSB of an odd number of bytes reads 00
cnet-wsb-odd-start | C | wSB of bytes at an odd address writes from the even one
cnet-wss-lword-order | C | wSS stores the data of an LWord byte by byte in reverse
cnet-readonly-code | C | writes to F and N are refused with 7132
cnet-mon-fifth-lost | C | the fifth registration since the start is acknowledged and lost
cnet-mon-0f-refused | C | registration 0F is refused
cnet-mon-10-alias | C | registration numbers above 0F are taken modulo 16
cnet-mon-8-alias | C | registrations 08-0F are kept in the places of 00-07
cnet-mon-range-code | C | y of a number above 0F is refused with 0090
cnet-mon-none-code | C | y of a number not registered is refused with 0190
cnet-mon-snapshot | C | y returns the values of the time of registration
cnet-mon-refused-clears | C | a refused registration deletes the earlier one of its number
cnet-mon-kept | C | registering a number again is acknowledged, the first stays
cnet-mon-unchecked | C | the range of a registration is checked at y only
cnet-mon-nak-clears | C | any NAK to r or w deletes registration 00
cnet-mon-eight-blocks | C | y returns at most eight blocks
cnet-mon-sb-ends | C | y of an SB registration always returns as many elements as the last registered SB run
cnet-mon-write-accepted | C | a registration of WSS content is acknowledged
mb-fc02-base | RAT | function 02 reads the bit write area
mb-0f-padding | RAT | the padding bits of function 0F are written too
mb-0f-1968-refused | RAT | function 0F refuses 1968 bits
mb-0f-1969 | RAT | function 0F accepts 1969-1976 bits
mb-bits-2000-refused | RAT | reading 2000 bits is refused
mb-bits-2001 | RAT | reading 2001-2008 bits is accepted
mb-words-read-more | RAT | reading 126 words is accepted
mb-words-read-fewer | RAT | the limit of words read is one less (119 serial, 124 TCP)
mb-words-write-more | RAT | one word more than the limit is written
mb-words-write-fewer | RAT | the full number of words in function 10 is refused
mb-zero-03 | RAT | function 03 of 0 words is answered with no data
mb-zero-0f | RAT | function 0F of 0 bits is answered
mb-10-bytes-ignored | RAT | the byte count of function 10 is not compared with the word count
mb-0f-bytes-more | RAT | function 0F accepts one byte more than the bits need
mb-05-any-on | RAT | function 05 takes any value but 0000 as on
mb-05-low-byte | RAT | function 05 looks at the high byte of the value only
mb-limit-code | RAT | a count above the limit is refused with 02
mb-02-first | RAT | the address is checked before the count
mb-end-9999 | RAT | bit address 9999 is served
mb-start-only | RAT | reads of words check the first address only
mb-last-word-refused | RAT | the last word of the area is refused
mb-function-80-silent | RAT | function codes 80 and above are not answered
mb-unknown-code | RAT | unknown functions are refused with 03
mb-10-echo-bytes | RAT | the reply of function 10 has the byte count in place of the word count
mb-10-partial | RAT | function 10 past the end writes what fits before its exception
mb-read-padding | RAT | unused bits of the last byte show the bits that follow
mb-02-unaligned | RAT | function 02 from an address not divisible by 8 starts at the byte, if more than 16 bits are read (needs other bases or --preset: P is not written over Modbus by default)
mb-04-swap | RAT | function 04 sends the low byte first (needs other bases or --preset, as above)
mb-10-odd-last | RAT | function 10 does not write the last word of an odd number above one
mb-05-address-byte | RAT | function 05 uses the low byte of the address
mb-0f-word-border | RAT | function 0F loses the bits behind the second word border
mb-surplus-read | RAT | surplus bytes behind a read request are accepted
mb-count-byte | RAT | the high byte of a word count is not looked at
mb-after-exception | RAT | the request after an exception is not answered
mb-stale-padding | RAT | after a reply of more than 100 bytes the next bit reply has ones in its padding
mb-17th-silent | RAT | every 17th request is not answered
mb-short-silent | RAT | a request shorter than its function needs is not answered
rtu-crc-low | R | only the first byte of the CRC is compared
rtu-crc-high | R | only the second byte of the CRC is compared
rtu-crc-either | R | the CRC is accepted in either byte order
rtu-crc-06 | R | the CRC of function 06 is not compared
rtu-crc-answered | R | a wrong CRC is answered with exception 03
rtu-crc-exception | R | the CRC of an exception is made with the function code without 80
rtu-crc-next-lost | R | the frame after a wrong CRC is lost
rtu-broadcast | R | station 0 is answered
rtu-station-31 | R | the station is compared modulo 32
rtu-foreign-next | R | the request after one for another station is taken for that station's reply
rtu-gap-joined | R | a gap inside a frame is not seen, the halves are joined
rtu-tail-ignored | R | bytes behind a complete request with right CRC are ignored
rtu-buffer-192 | R | frames above 192 bytes are lost
asc-lrc-high | A | only the first digit of the LRC is compared
asc-lrc-case | A | an LRC in lower case is taken as wrong
asc-lrc-05 | A | the LRC of function 05 is not compared
asc-lrc-exception | A | the LRC of an exception is a ones complement
asc-lower | A | digits a-f in lower case are not accepted
asc-no-restart | A | a colon inside a frame does not restart it
asc-lf-alone | A | LF without CR ends a frame
asc-cr-alone | A | CR without LF ends a frame
asc-gap-kept | A | a gap of more than a second does not end a frame
asc-gap-short | A | a gap of more than 100 ms ends a frame
asc-odd-digit | A | an odd digit before the end is dropped and the rest served
asc-255 | A | frames of more than 255 characters are lost
asc-reply-lower | A | replies use lower-case digits
asc-noise-kills | A | noise before the colon makes the frame lost
asc-broadcast | A | station 0 is answered
asc-not-hex | A | a character that is no hex digit counts as 0
asc-second-dropped | A | of two requests back to back the second is lost
tcp-tid-after-exception | T | the reply after an exception repeats its transaction id
tcp-tid-byte | T | the high byte of the transaction id comes back as 0
tcp-unit-exception | T | an exception carries unit 0
tcp-unit-own | T | only units 0, 1 and FF are served
tcp-unit-fixed | T | a reply always carries unit 1
tcp-protocol-ignored | T | a protocol id other than 0 is served
tcp-protocol-reset | T | a protocol id other than 0 resets the connection
tcp-length-ignored | T | the request is taken by its function, whatever the length field says
tcp-length-0-kept | T | a length field of 0 or 1 is passed over, the connection stays
tcp-length-exception | T | the length field of an exception is 4
tcp-length-250 | T | a length field above 250 resets the connection
tcp-unit-last-connection | T | the unit of a reply is that of the last request on any connection with a different one
net-split-lost | TF | a frame in two segments is lost
net-split-header | TF | a frame cut inside its header is lost, one cut behind it is served
net-second-dropped | TF | the second frame of a segment is lost
net-third-dropped | TF | the third frame of a segment is lost
net-tail-lost | TF | a partial frame behind a complete one in a segment is lost
net-shared-buffer | TF | connections share one receive buffer
net-fifth-accepted | TF | a fifth connection is served
net-fourth-refused | TF | the fourth connection is refused
net-fifth-disturbs | TF | refusing a fifth connection resets the first one
net-fin-answered | TF | the end of a connection is answered with FIN, not with RST
net-slot-leak | TF | a connection closed inside a frame keeps its slot
net-wait-not-restarted | TF | the reception waiting time is not restarted by requests
fe-invoke-swap | F | the invoke id comes back with its bytes exchanged in continuous read replies
fe-invoke-nak | F | a NAK carries the invoke id of the request before
fe-invoke-last-connection | F | the invoke id of a write reply is the one last seen on another connection, if any
fe-check-enforced | F | a request with a header check other than right is refused, 0 too
fe-check-nak | F | the header check of a NAK is 0
fe-check-carry | F | the header check of a reply leaves out the position byte
fe-glofa-lsis | F | the reply to LGIS-GLOFA carries LSIS-XGT
fe-id-half | F | only the first four bytes of the company id are compared
fe-id-echo | F | the reply to an unknown company id repeats it
fe-source-checked | F | a request whose source is not 33 is not answered
fe-reserved-checked | F | a request whose reserved word is not 0 is refused with 0024
fe-cpu-a0 | F | replies carry CPU A0
fe-source-nak | F | a NAK carries source 33
fe-count-16-refused | F | 16 blocks are refused
fe-count-17 | F | 17 blocks are accepted in a read
fe-count-0 | F | 0 blocks are answered with 0 blocks
fe-512-refused | F | 512 bytes of continuous read are refused
fe-513 | F | 513-514 bytes of continuous write are accepted
fe-zero-bytes | F | a continuous read of 0 bytes is answered
fe-odd-start | F | a continuous read at an odd byte starts at the even one
fe-odd-write | F | a continuous write of an odd number of bytes loses the last one
fe-odd-size | F | the reply to a continuous read of an odd number of bytes has the size rounded up, the data not
fe-code-end | F | past the end of the area is refused with 0003
fe-code-form | F | a malformed name is refused with 0003
fe-code-continuous | F | a continuous read of words is refused with 0002
fe-code-command | F | an unknown command is refused with 0024
fe-code-readonly | F | a write to F or N is refused with 0004
fe-nak-command | F | the NAK to a write has the reply code of a read
fe-nak-type | F | a NAK carries type 00
fe-partial | F | a write refused at a later block has written the earlier ones
fe-type-mismatch | F | a name of another type than the frame's is accepted in a read and served as its own
fe-name-16-refused | F | names of 16 characters are refused
fe-name-17 | F | names of 17 characters are accepted
fe-name-lower | F | names in lower case are refused
fe-size-ignored | F | the size of a written element is not compared with its type
fe-bit-nonzero | F | a written bit is 1 when any bit of its byte is
fe-write-count | F | the reply to a write of several blocks says 1 block
fe-lword-size | F | the size in the reply of an LWord is 4
fe-long-stale | F | the individual reply after one of more than 300 bytes has the type of that one
fe-17th-silent | F | every 17th request is not answered
fe-continuous-type | F | the reply to a continuous write carries type 01
fe-length-dword | F | the length field of the reply to a DWord read of several blocks counts two bytes less for each further block
fe-last-block-first | F | 16 blocks are answered with the last two exchanged
ls-sum-low-digit | L | only the second digit of the sum is compared
ls-sum-high-digit | L | only the first digit of the sum is compared
ls-sum-seven-bits | L | the sum is compared in seven bits
ls-sum-ignored-w | L | the sum of a write is not compared
ls-sum-lower-refused | L | a sum in lower case is taken as wrong
ls-sum-not-hex | L | a character of the sum that is no hex digit counts as 0
ls-sum-enq-too | L | a sum that counts ENQ is accepted, too
ls-sum-silent | L | a wrong sum is not answered
ls-sum-wrong-written | L | a write with a wrong sum is refused with FE, and written
ls-sum-nak-head | L | the sum of a NAK counts its header
ls-sum-after-nak | L | the sum of the ACK after a NAK is one too high
ls-sum-eight-words | L | the sum of a reply of eight words leaves out the last character
ls-sum-reply-lower | L | the sum of a reply has lower-case digits
ls-station-00 | L | station 00 is answered
ls-station-low-digit | L | only the second digit of the station is compared
ls-station-32 | L | the station is compared modulo 32
ls-station-lower | L | a station in lower case is not answered (needs --station 10 or above)
ls-station-decimal | L | the station is taken as decimal digits (needs --station 10 or above)
ls-foreign-next-lost | L | the request after one for another station is taken for that station's reply
ls-foreign-fe | L | a wrong sum is answered with FE when it is for another station, too
ls-lower-command | L | r and w are served
ls-function-code | L | an unknown function is refused with ID
ls-function-before-sum | L | an unknown function with a wrong sum is refused with IF
ls-nak-function-r | L | the NAK to an unknown function carries R
ls-nak-four | L | a NAK carries four characters, as 8.1.1 shows it
ls-nak-etx | L | a NAK ends with ETX
ls-address-lower | L | an address in lower case is refused
ls-address-decimal | L | an address with the digits A-F is refused
ls-address-strtol | L | an address is read up to the first character that is no hex digit, behind blanks and a sign
ls-address-form-code | L | an address that is not hex is refused with ID
ls-end-0fff | L | the last word, 0FFF, is refused
ls-end-12ff | L | the last word, 12FF, is refused
ls-1300-served | L | 1300, one past the end, is served
ls-gap-served | L | 1000 to 11FF are served
ls-1200-alias | L | address bit 12 is dropped: 1200 and up are 0200 and up
ls-0800-alias | L | 0800 to 0FFF share their memory with 0000 to 07FF
ls-8000-alias | L | address bit 15 is dropped
ls-range-first | L | of a read the first address only is checked
ls-range-last | L | of a run the last address only is checked, in 16 bits
ls-range-code | L | a run that leaves the range is refused with ID
ls-page-refused | L | a run over a border of 256 words is refused
ls-page-wraps | L | a run over a border of 256 words goes on at the beginning of its page
ls-run-joins | L | a run past 0FFF goes on at 1200
ls-page-pointer | L | a run over a border of 256 words is checked right, and goes on at the beginning of its page
ls-count-8-refused | L | a write of eight words is refused
ls-count-9 | L | nine words are read
ls-count-0-ack | L | a read of 0 words is acknowledged
ls-count-missing-one | L | a read without count reads one word
ls-count-letters | L | counts A to F are read as 10 to 15
ls-count-masked | L | the count is the low four bits of its character
ls-count-code | L | a wrong count is refused with IA
ls-surplus-read | L | characters behind the count of a read are ignored
ls-surplus-write | L | data behind the words that are counted are ignored
ls-surplus-half | L | up to three characters behind the words that are counted are ignored
ls-data-short | L | data that are missing are written as 0
ls-data-lower-refused | L | data in lower case are refused
ls-data-first-checked | L | the digits of the first word only are checked
ls-data-code | L | data that are not hex are refused with IA
ls-data-reply-lower | L | a read is answered with lower-case digits
ls-eighth-order | L | the last two of eight words that are read come exchanged
ls-eighth-lost | L | the eighth word of a write is acknowledged, not written
ls-ack-first-word | L | the ACK of a write repeats the first word only
ls-ack-as-sent | L | the ACK of a write repeats lower-case digits as they came
ls-value-signed | L | values above 7FFF are stored as 7FFF
ls-first-read-old | L | the first read of a word after a write gives the value before
ls-100-writes | L | the words after the hundredth that is written are acknowledged, not stored
ls-partial-data | L | a write refused for a later word's digits has written the earlier ones
ls-partial-range | L | a write past the end writes what fits before its NAK
ls-partial-rights | L | a write that reaches read-only words has written those before
ls-rights-first | L | of a write the first address only is checked for read-only
ls-rights-code | L | a write to a read-only word is refused with IA
ls-read-only-written | L | read-only words are written
ls-read-only-hidden | L | a read from a read-only word is refused
ls-0003-writable | L | 0003 can be written
ls-000f-writable | L | 000F can be written
ls-0010-read-only | L | 0010 cannot be written
ls-ia-id-swapped-w | L | IA and ID are exchanged in the NAK to a write
ls-code-latched | L | the second refusal in a row repeats the code of the first
ls-refused-next-lost | L | the write after a refusal is acknowledged, not written
ls-five-refusals-lock | L | after five refusals in a row writes are refused until something is granted
ls-long-then-nak | L | the NAK after a reply of eight words has two characters too many
ls-noise-kills | L | noise before ENQ makes the frame lost
ls-enq-no-restart | L | ENQ inside a frame does not restart it
ls-second-dropped | L | of two requests back to back the second is lost
ls-third-dropped | L | of three requests back to back the third is lost
ls-head-any | L | ACK and NAK begin a request, too
ls-etx-tail | L | ETX ends a request, too
ls-eot-unchecked | L | a read ends after its twelve characters, whatever the last one is
ls-gap-drops | L | a pause of more than 50 ms inside a frame drops it
ls-buffer-40 | L | frames above 40 bytes are lost
ls-buffer-128 | L | frames above 128 bytes are lost
ls-overrun-next-lost | L | the request after more than 256 bytes without EOT is lost
ls-short-fe | L | a frame too short for station, command and sum is refused with FE
ls-17th-silent | L | every 17th request is not answered
ls-256th-silent | L | every 256th request is not answered
ls-write-deferred | L | a write is stored when its ACK is out: a read back to back with it gives the old value
ls-other-reply-kills | L | the request behind another inverter's ACK is lost
ls-ten-refusals-silent | L | from the tenth refusal in a row on refusals are silent
ls-three-fe-silent | L | the request after three wrong sums in a row is not answered
ls-long-then-short | L | a read of one word after a reply of eight words is answered with two
ls-eight-then-one | L | a write of one word after one of eight writes the second word of that again
ls-enq-late | L | ENQ restarts a frame in its first 16 characters only
ls-crlf-skipped | L | CR and LF inside a frame are passed over
ls-seven-bit | L | the highest bit of a character is dropped
ls-rights-skipped | L | read-only words inside a write are passed over, the others written, all acknowledged
ls-order-guessed | L | a write that is malformed is tried in the other order of address and count
ls-order-ignored | L | a write has always the address first (needs --write-order count_first)
ls-buffer-255 | L | frames of 256 bytes are lost
ls-buffer-512 | L | frames of up to 512 bytes are answered
'''

_faults = FaultTable(TABLE, GROUPS)
FAULTS, set_fault, fault = _faults.all, _faults.choose, _faults.fault
